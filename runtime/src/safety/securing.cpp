#include "safety/securing.hpp"

#include <sched.h>
#include <time.h>

#include <algorithm>
#include <iterator>

#include "system/waker.hpp"

namespace tessera {
namespace {

/// The work of one thread.
[[nodiscard]] bool insist_on_safe_commands(Effectors& effectors, SafeReason why) {
  const std::int64_t until_ns = monotonic_ns() + Effectors::patience.count();
  bool taken = effectors.make_safe(why, Effectors::Busy::leaves_out);
  while (!taken && monotonic_ns() < until_ns) {
    const timespec pause{.tv_sec = 0, .tv_nsec = Effectors::between_attempts.count()};
    nanosleep(&pause, nullptr);
    taken = effectors.insist(why, Effectors::Busy::leaves_out);
  }
  return taken;
}

}  // namespace

Securing::Securing(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, int priority,
                   std::function<void()> news)
    : priority_(priority), news_(std::move(news)), jobs_(executors.size()) {
  for (std::size_t index = 0; index < executors.size(); ++index) {
    if (executors[index]->effectors().none()) continue;
    // allocated now, because there may be no memory when it is needed
    jobs_[index] = std::make_unique<Job>();
    jobs_[index]->effectors = &executors[index]->effectors();
    jobs_[index]->owner = this;
  }
}

Securing::~Securing() {
  for (const auto& job : jobs_)
    if (job != nullptr) join(*job);
}

void Securing::join(Job& job) {
  if (job.started) pthread_join(job.thread, nullptr);
  job.started = false;
}

void* Securing::run(void* argument) {
  Job& job = *static_cast<Job*>(argument);
  job.taken.store(insist_on_safe_commands(*job.effectors, job.why), std::memory_order_relaxed);
  job.done.store(true, std::memory_order_release);
  job.owner->news_();
  return nullptr;
}

bool Securing::start(Job& job, bool realtime) const {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  if (realtime) {
    const sched_param parameters{.sched_priority = priority_};
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    pthread_attr_setschedparam(&attributes, &parameters);
  }
  const bool started = pthread_create(&job.thread, &attributes, run, &job) == 0;
  pthread_attr_destroy(&attributes);
  return started;
}

void Securing::secure(std::uint32_t instance, SafeReason why) {
  if (jobs_[instance] == nullptr || is_under_way(instance)) return;
  Job& job = *jobs_[instance];
  join(job);
  job.why = why;
  job.since_ns = monotonic_ns();
  job.done.store(false, std::memory_order_relaxed);
  job.started = (priority_ > 0 && start(job, /*realtime=*/true)) || start(job, /*realtime=*/false);
  if (job.started) return;
  job.done.store(true, std::memory_order_relaxed);
  // no thread can be made, so this thread does it
  job.effectors->make_safe(why, Effectors::Busy::leaves_out);
}

bool Securing::is_under_way(std::uint32_t instance) const {
  const Job* job = jobs_[instance].get();
  return job != nullptr && job->started && !job->done.load(std::memory_order_acquire);
}

bool Securing::done() const {
  for (std::uint32_t instance = 0; instance < jobs_.size(); ++instance)
    if (is_under_way(instance)) return false;
  return true;
}

std::vector<std::string> Securing::refusing() const {
  std::vector<std::string> names;
  for (const auto& job : jobs_) {
    if (job == nullptr || !job->started) continue;
    const bool done = job->done.load(std::memory_order_acquire);
    if (done ? job->taken.load(std::memory_order_relaxed)
             : monotonic_ns() - job->since_ns < Effectors::patience.count())
      continue;
    std::ranges::move(job->effectors->unsafe(), std::back_inserter(names));
  }
  return names;
}

Time Securing::overdue_from(Time now) const {
  Time next = Time::max();
  for (std::uint32_t instance = 0; instance < jobs_.size(); ++instance)
    if (is_under_way(instance)) {
      const Duration lasts(monotonic_ns() - jobs_[instance]->since_ns);
      next = std::min(next, now + std::max(Effectors::patience - lasts, Effectors::between_attempts));
    }
  return next;
}

void Securing::leave_behind() {
  for (const auto& job : jobs_)
    if (job != nullptr && job->started && !job->done.load(std::memory_order_acquire)) {
      pthread_detach(job->thread);
      job->started = false;
    }
}

void Securing::collect(RecordingLane* lane) {
  for (const auto& job : jobs_)
    if (job != nullptr && job->started && job->done.load(std::memory_order_acquire)) {
      join(*job);
      job->effectors->record(lane);
    }
}

}  // namespace tessera
