#include "steady_run.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <optional>
#include <system_error>

#include "console.hpp"
#include "realtime.hpp"
#include "stillness.hpp"
#include "watchdogs.hpp"

namespace tessera {
namespace {

constexpr Duration world_step = std::chrono::milliseconds(1);
constexpr Duration progress_step = std::chrono::milliseconds(200);
constexpr Duration security_delay = std::chrono::milliseconds(20);  // then devices get their safe command
constexpr Duration first_patience = std::chrono::seconds(1);        // then it says whom it waits for

}  // namespace

SteadyRun::SteadyRun(std::uint32_t instances)
    : wake_words_(std::make_unique<WakeWord[]>(instances)),
      gone_(std::make_unique<std::atomic<bool>[]>(instances)),
      collected_(instances),
      news_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

SteadyRun::~SteadyRun() {
  if (news_ >= 0) close(news_);
}

void SteadyRun::tell_supervisor() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(news_, &one, sizeof one);
}

void SteadyRun::run_subsystem(SubsystemExecutor& executor, std::uint32_t instance, RunControl& control) {
  // Releases are exact to what the timer can do; by default the kernel may add 50 us to spare itself a
  // wake-up.
  prctl(PR_SET_TIMERSLACK, 1UL);
  const Instance& its = *executor.operations().parts().instance;
  if (const std::string denied = schedule_this_thread(its.policies.realtime); !denied.empty()) deny(denied);
  step_until_end(executor, wake_words_[instance], control);
  if (!control.has_ended(instance)) executor.leave();
  gone_[instance].store(true, std::memory_order_release);
  tell_supervisor();
}

void SteadyRun::step_until_end(SubsystemExecutor& executor, WakeWord& wakes,
                               const RunControl& control) const {
  while (!control.stopping()) {
    const std::uint32_t ticket = wakes.ticket();
    const SubsystemExecutor::Progress progress = executor.step();
    if (progress.state != SubsystemExecutor::State::waiting) break;
    wakes.sleep(ticket, progress.deadline == Time::max() ? -1 : clock_.absolute_ns(progress.deadline));
  }
}

/// One warning a run: a thousand threads may be denied the same.
void SteadyRun::deny(const std::string& what) {
  if (denied_.exchange(true, std::memory_order_relaxed)) return;
  console::print(LogLevel::warning, clock_.now(), "tessera",
                 fmt::format("not in real time, as the specification asks ({}); give the permission with "
                             "CAP_SYS_NICE and CAP_IPC_LOCK, or limits rtprio and memlock",
                             what));
}

void SteadyRun::run_world(World& world, RunControl& control) {
  for (Time next{}; !control.stopping(); next += world_step) {
    const std::uint32_t ticket = world_wakes_.ticket();
    try {
      world.advance_to(clock_.now());
    } catch (const std::exception& exception) {
      control.request_stop(fmt::format("the world: {}", exception.what()), /*fault=*/true);
      return tell_supervisor();
    }
    next = std::max(next, clock_.now());  // a slow world does not try to catch up
    if (!control.stopping()) world_wakes_.sleep(ticket, clock_.absolute_ns(next + world_step));
  }
}

Ending SteadyRun::run(Assembly& assembly, UpperLayers& upper, const StopSignals& signals) {
  if (wants_realtime(assembly.system.instances))
    if (const std::string denied = lock_memory(); !denied.empty()) deny(denied);
  clock_.restart();
  upper.enter(clock_.now());
  for (const auto& executor : assembly.executors) executor->enter();
  std::vector<std::thread> threads;
  try {
    if (assembly.world != nullptr)
      threads.emplace_back([&] { run_world(*assembly.world, assembly.control); });
    for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) {
      threads.emplace_back(
          [&, instance] { run_subsystem(*assembly.executors[instance], instance, assembly.control); });
      ++started_;
    }
  } catch (const std::system_error& error) {
    assembly.control.request_stop(fmt::format("no thread for every subsystem: {}", error.what()),
                                  /*fault=*/true);
  }
  if (assembly.options.monitor) {
    monitor_.emplace(assembly, clock_);
    monitor_->complain_of_failure(clock_.now());
  }
  supervise(assembly, upper, signals);
  await_threads(assembly);
  for (std::thread& thread : threads) thread.join();
  collect_ended(assembly, upper);

  const Time now = clock_.now();
  if (upper.ended()) return {"net ended", assembly.control.failed(), now};
  if (duration_over_) return {"duration", assembly.control.failed(), now};
  if (const int signal = StopSignals::pending(); signal != 0)
    return {StopSignals::name(signal), assembly.control.failed(), now};
  return {fmt::format("stopped: {}", assembly.control.reason()), assembly.control.failed(), now};
}

void SteadyRun::supervise(Assembly& assembly, UpperLayers& upper, const StopSignals& signals) {
  const Time end = assembly.options.duration ? Time(*assembly.options.duration) : Time::max();
  ProgressLine progress(assembly.options.progress, assembly.options.duration);
  RunControl& control = assembly.control;
  Watchdogs watchdogs(assembly.executors,
                      assembly.recorder == nullptr ? nullptr : assembly.recorder->system_lane());
  Stillness stillness(started_);
  const auto gone = [&](std::uint32_t instance) { return gone_[instance].load(std::memory_order_acquire); };
  while (!control.stopping()) {
    collect_ended(assembly, upper);
    const Time now = clock_.now();
    if (upper.ended()) {
      control.request_stop("net ended", /*fault=*/false);
    } else if (const int signal = StopSignals::pending(); signal != 0) {
      control.request_stop(StopSignals::name(signal), /*fault=*/false);
    } else if (now >= end) {
      duration_over_ = true;
      control.request_stop("duration", /*fault=*/false);
    } else if (stillness.look(now, wake_words_.get(), gone)) {
      control.request_stop(why_nothing_happens(assembly), /*fault=*/true);
    } else {
      progress.update(now);
      assembly.signals.raise_due(now);
      const Time next = std::min({end, stillness.next(), watchdogs.check(now), assembly.signals.next()});
      await_news(signals.descriptor(),
                 assembly.options.progress ? std::min(next, now + progress_step) : next);
    }
  }
  wake_all(static_cast<std::uint32_t>(assembly.executors.size()));
}

void SteadyRun::collect_ended(const Assembly& assembly, UpperLayers& upper) {
  for (std::uint32_t instance = 0; instance < collected_.size(); ++instance) {
    if (collected_[instance] || !assembly.control.has_ended(instance)) continue;
    collected_[instance] = true;
    upper.subsystem_ended(instance, clock_.now());
  }
}

void SteadyRun::await_threads(const Assembly& assembly) {
  const Time since = clock_.now();
  Duration patience = first_patience;
  bool secured = false;
  const auto all_gone = [&] {
    for (std::uint32_t instance = 0; instance < started_; ++instance)
      if (!gone_[instance].load(std::memory_order_acquire)) return false;
    return true;
  };
  while (!all_gone()) {
    await_news(-1, since + (secured ? patience : security_delay));
    const Duration waited = clock_.now() - since;
    if (!secured && waited >= security_delay) {
      secure_devices(assembly);
      secured = true;
    }
    if (waited < patience) continue;
    say_waiting(assembly, waited);
    patience = 2 * waited;
  }
}

void SteadyRun::secure_devices(const Assembly& assembly) const {
  for (std::uint32_t instance = 0; instance < started_; ++instance) {
    if (gone_[instance].load(std::memory_order_acquire)) continue;
    SubsystemExecutor& executor = *assembly.executors[instance];
    if (!executor.leave_from_outside())
      console::print(LogLevel::error, clock_.now(), executor.path(),
                     "its devices are in use, or refuse the safe command");
  }
}

void SteadyRun::say_waiting(const Assembly& assembly, Duration since) const {
  for (std::uint32_t instance = 0; instance < started_; ++instance) {
    if (gone_[instance].load(std::memory_order_acquire)) continue;
    const SubsystemExecutor& executor = *assembly.executors[instance];
    const std::uint16_t behaviour = executor.gauges().behaviour.load(std::memory_order_relaxed);
    const SubsystemNet& net = *executor.operations().parts().instance->net;
    console::print(LogLevel::warning, clock_.now(), "tessera",
                   fmt::format("waits for {} in {} ({:.1f} s)", executor.path(),
                               net.behaviours[behaviour].name, seconds(since)));
  }
}

/// signals: a descriptor, or -1.
void SteadyRun::await_news(int signals, Time until) const {
  std::array<pollfd, 2> sources{pollfd{.fd = news_, .events = POLLIN, .revents = 0},
                                pollfd{.fd = signals, .events = POLLIN, .revents = 0}};
  const Duration left = std::max(until - clock_.now(), Duration::zero());
  const timespec limit{.tv_sec = left.count() / 1'000'000'000, .tv_nsec = left.count() % 1'000'000'000};
  ppoll(sources.data(), sources.size(), until == Time::max() ? nullptr : &limit, nullptr);
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = read(news_, &count, sizeof count);
}

void SteadyRun::wake_all(std::uint32_t instances) {
  world_wakes_.wake();
  for (std::uint32_t instance = 0; instance < instances; ++instance) wake_words_[instance].wake();
}

}  // namespace tessera
