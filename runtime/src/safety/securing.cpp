#include "safety/securing.hpp"

#include <sched.h>
#include <time.h>

#include <algorithm>
#include <utility>

#include "system/waker.hpp"

namespace tessera {
namespace {

/// The work of one thread. A device that is in use at the second attempt, too, resists: the first one may have met a
/// command that was just being given.
[[nodiscard]] bool insist_on_safe_command(Effectors& effectors, std::size_t device, SafeReason why) {
  const std::int64_t until_ns = monotonic_ns() + Effectors::patience.count();
  bool taken = effectors.make_safe_one(device, why, Effectors::Busy::leaves_out);
  while (!taken && monotonic_ns() < until_ns) {
    const timespec pause{.tv_sec = 0, .tv_nsec = Effectors::between_attempts.count()};
    nanosleep(&pause, nullptr);
    taken = !effectors.owes(device) || effectors.make_safe_one(device, why, Effectors::Busy::leaves_out);
    if (!taken) effectors.note_resistance(device);
  }
  return taken;
}

}  // namespace

Securing::Securing(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, int priority,
                   std::function<void()> news)
    : priority_(priority), news_(std::move(news)), jobs_(executors.size()) {
  for (std::size_t index = 0; index < executors.size(); ++index)
    for (std::size_t device = 0; device < executors[index]->effectors().size(); ++device) {
      // allocated now, because there may be no memory when it is needed
      Job& job = *jobs_[index].emplace_back(std::make_unique<Job>());
      job.effectors = &executors[index]->effectors();
      job.device = device;
      job.owner = this;
    }
}

Securing::~Securing() {
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs) join(*job);
}

void Securing::join(Job& job) {
  if (job.started) pthread_join(job.thread, nullptr);
  job.started = false;
}

void* Securing::run(void* argument) {
  Job& job = *static_cast<Job*>(argument);
  job.taken.store(insist_on_safe_command(*job.effectors, job.device, job.why), std::memory_order_relaxed);
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
  for (const auto& job : jobs_[instance])
    if (!is_under_way(*job)) secure(*job, why);
}

void Securing::secure(Job& job, SafeReason why) const {
  join(job);
  job.why = why;
  job.since_ns = monotonic_ns();
  job.resists = false;
  job.done.store(false, std::memory_order_relaxed);
  job.started = (priority_ > 0 && start(job, /*realtime=*/true)) || start(job, /*realtime=*/false);
  if (job.started) return;
  job.done.store(true, std::memory_order_relaxed);
  // no thread can be made, so this thread does it
  job.effectors->make_safe_one(job.device, why, Effectors::Busy::leaves_out);
}

bool Securing::is_under_way(std::uint32_t instance) const {
  return std::ranges::any_of(jobs_[instance], [](const auto& job) { return is_under_way(*job); });
}

bool Securing::done() const {
  for (std::uint32_t instance = 0; instance < jobs_.size(); ++instance)
    if (is_under_way(instance)) return false;
  return true;
}

std::vector<std::string> Securing::refusing() const {
  std::vector<std::string> names;
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs) {
      if (!job->started) continue;
      const bool done = job->done.load(std::memory_order_acquire);
      const bool refuses = done ? !job->taken.load(std::memory_order_relaxed)
                                : monotonic_ns() - job->since_ns >= Effectors::patience.count();
      if (refuses && !job->effectors->is_safe(job->device))
        names.push_back(job->effectors->name(job->device));
    }
  return names;
}

void Securing::note_resistance() {
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs) {
      const bool lasts = is_under_way(*job) && monotonic_ns() - job->since_ns >= usual_time.count();
      if (!lasts || std::exchange(job->resists, true) || job->effectors->is_safe(job->device)) continue;
      job->effectors->note_resistance(job->device);
    }
}

Time Securing::overdue_from(Time now) const {
  Time next = Time::max();
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs)
      if (is_under_way(*job)) {
        const Duration left =
            (job->resists ? Effectors::patience : usual_time) - Duration(monotonic_ns() - job->since_ns);
        next = std::min(next, now + std::max(left, Effectors::between_attempts));
      }
  return next;
}

void Securing::leave_behind() {
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs)
      if (is_under_way(*job)) {
        pthread_detach(job->thread);
        job->started = false;
      }
}

void Securing::collect(RecordingLane* lane) {
  for (const auto& jobs : jobs_)
    for (const auto& job : jobs)
      if (job->started && job->done.load(std::memory_order_acquire)) {
        join(*job);
        job->effectors->record(lane);
      }
}

}  // namespace tessera
