// How a run on the steady clock ends: it waits for its threads, secures devices, and may give up.

#include <fmt/format.h>

#include <algorithm>

#include "run/steady_run.hpp"
#include "system/console.hpp"

namespace tessera {
namespace {

// After this delay, the devices of threads that have not ended get their safe command.
constexpr Duration security_delay = std::chrono::milliseconds(20);
// After this time, a message says which threads the end waits for.
constexpr Duration first_patience = std::chrono::seconds(1);

[[nodiscard]] std::string_view behaviour_of(const SubsystemExecutor& executor) {
  const std::uint16_t behaviour = executor.gauges().behaviour.load(std::memory_order_relaxed);
  return executor.operations().parts().instance->net->behaviours[behaviour].name;
}

/// "robot.arm in move", or "read() of robot.sonar.distance": the function has not been called then.
[[nodiscard]] std::string awaited(const SubsystemExecutor& executor) {
  const std::string driver = executor.operations().driver_being_read();
  return driver.empty() ? fmt::format("{} in {}", executor.path(), behaviour_of(executor)) : driver;
}

/// "robot.arm has not returned from move"
[[nodiscard]] std::string not_returned(const SubsystemExecutor& executor) {
  const std::string driver = executor.operations().driver_being_read();
  return driver.empty() ? fmt::format("{} has not returned from {}", executor.path(), behaviour_of(executor))
                        : fmt::format("{} has not returned", driver);
}

[[nodiscard]] std::string unsafe_devices(SubsystemExecutor& executor) {
  const std::vector<std::string> names = executor.effectors().unsafe();
  return names.empty() ? "" : "; " + not_safe(names);
}

}  // namespace

bool SteadyRun::has_ended(std::uint32_t instance) const {
  return instance >= started_ || gone_[instance].load(std::memory_order_acquire);
}

void SteadyRun::await_threads(const Assembly& assembly, Securing& securing) {
  const Time since = clock_.now();
  Duration patience = first_patience;
  if (liveness_) liveness_->stopping();
  bool secured = false;
  const auto all_gone = [&] {
    for (std::uint32_t instance = 0; instance < started_; ++instance)
      if (!has_ended(instance)) return false;
    return securing.done();
  };
  for (Duration waited{}; !all_gone();) {
    Duration next = secured ? patience : security_delay;
    for (const Duration limit : {give_up_.unsafe, give_up_.safe})
      if (limit > waited) next = std::min(next, limit);
    const Time beat = liveness_ ? show_life() : Time::max();
    await_news(std::min(since + next, beat));
    securing.collect(assembly.system_lane());
    waited = clock_.now() - since;
    if (!secured && waited >= security_delay) {
      secure_devices(securing);
      secured = true;
    }
    if (gives_up(assembly, waited) && !all_gone()) {
      given_up_after_ = waited;
      return;
    }
    if (waited < patience) continue;
    say_waiting(assembly, securing, waited);
    patience = 2 * waited;
  }
}

bool SteadyRun::gives_up(const Assembly& assembly, Duration waited) const {
  if (!give_up_.end_process || waited < std::min(give_up_.safe, give_up_.unsafe)) return false;
  const bool all_safe = std::ranges::all_of(
      assembly.executors, [](const auto& executor) { return executor->effectors().unsafe().empty(); });
  return waited >= (all_safe ? give_up_.safe : give_up_.unsafe);
}

void SteadyRun::secure_devices(Securing& securing) const {
  for (std::uint32_t instance = 0; instance < started_; ++instance)
    if (!has_ended(instance)) securing.secure(instance, {SafeReason::Kind::leaves});
}

void SteadyRun::say_waiting(const Assembly& assembly, const Securing& securing, Duration since) const {
  const auto say = [&](const std::string& text) {
    console::print(LogLevel::warning, clock_.now(), "tessera", text);
  };
  for (std::uint32_t instance = 0; instance < started_; ++instance) {
    SubsystemExecutor& executor = *assembly.executors[instance];
    if (!has_ended(instance))
      say(fmt::format("waits for {} ({:.1f} s){}", awaited(executor), seconds(since),
                      unsafe_devices(executor)));
    else if (securing.is_under_way(instance))
      say(fmt::format("waits for the devices of {} ({:.1f} s){}", executor.path(), seconds(since),
                      unsafe_devices(executor)));
  }
}

void SteadyRun::end_threads(Assembly& assembly, Securing& securing) {
  liveness_.reset();  // a world may take long for its last step
  shown_.reset();
  for (std::thread& thread : beside_) thread.join();
  for (std::uint32_t instance = 0; instance < threads_.size(); ++instance)
    if (!has_given_up() || has_ended(instance))
      threads_[instance].join();
    else
      threads_[instance].detach();
  for (std::uint32_t instance = started_; instance < assembly.executors.size(); ++instance) {
    assembly.executors[instance]->leave();  // no thread could be made for it
    assembly.executors[instance]->insist();
  }
  securing.collect(assembly.system_lane());
  if (!has_given_up()) return securing_.reset();
  assembly.control.abandon();
  for (std::uint32_t instance = 0; instance < assembly.executors.size(); ++instance) {
    const bool left = !has_ended(instance) || securing.is_under_way(instance);
    left_behind_.push_back(left);
    const SubsystemExecutor& executor = *assembly.executors[instance];
    if (left)
      given_up_ +=
          fmt::format("; {} {:.1f} s after the stop", not_returned(executor), seconds(*given_up_after_));
  }
  securing.leave_behind();
  monitor_.reset();
}

Ending SteadyRun::ending(const Assembly& assembly, const UpperLayers& upper) const {
  const Time now = clock_.now();
  Ending ending{fmt::format("stopped: {}", assembly.control.reason()), assembly.control.failed(), now};
  if (const int signal = StopSignals::pending(); signal != 0) {
    ending.text = StopSignals::name(signal);
    ending.signal = signal;
  }
  if (duration_over_) ending.text = "duration";
  if (upper.ended()) ending.text = "net ended";
  if (duration_over_ || upper.ended()) ending.signal = 0;
  if (world_is_slow_) ending.world_time = world_time_.time_since_epoch();
  if (!has_given_up()) return ending;
  ending.text += given_up_;
  ending.failed = true;
  ending.left_behind = left_behind_;
  return ending;
}

}  // namespace tessera
