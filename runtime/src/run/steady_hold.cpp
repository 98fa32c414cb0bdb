// How a run on the steady clock stands still for a while: as a process that is suspended, or held by another process.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <string_view>
#include <utility>

#include "run/steady_run.hpp"
#include "system/console.hpp"

namespace tessera {
namespace {

// While devices get their safe commands, the supervisor looks that often whether they have them.
constexpr Duration between_looks = std::chrono::milliseconds(2),
                   longest_look = std::chrono::milliseconds(200);

void say_of_hold(std::string_view text, Time now, RecordingLane* lane) {
  console::print(LogLevel::info, now, "tessera", text);
  if (lane != nullptr) lane->text(Event::Kind::log, now, 0, text);
}

}  // namespace

/// Gives the safe commands. Then the process is suspended until another process continues it, and the
/// clock of the run stops with it.
void SteadyRun::suspend(Assembly& assembly, Securing& securing) {
  RunControl& control = assembly.control;
  RecordingLane* const lane = assembly.system_lane();
  control.suspend();
  const Time since = clock_.now();
  for (std::uint32_t instance = 0; instance < started_; ++instance)
    securing.secure(instance, {SafeReason::Kind::suspended});
  while (!securing.done() && securing.refusing().empty() && StopSignals::pending() == 0)
    await_news(clock_.now() + longest_look);
  securing.collect(lane);
  // A subsystem that has just seen the suspension may be in the middle of giving its own safe command.
  for (const Time until = clock_.now() + longest_look; any_owing(assembly) && clock_.now() < until;)
    await_news(clock_.now() + between_looks);
  if (any_owing(assembly))
    return control.request_stop("an effector refuses its safe command: not suspended", /*fault=*/true);
  if (const int signal = StopSignals::pending(); signal != 0)
    return control.request_stop(StopSignals::name(signal), /*fault=*/false);
  stop_process(since, lane);
  if (assembly.links != nullptr) assembly.links->set_origin(clock_.absolute_ns(Time{}));
  StopSignals::resume();
  control.resume(clock_.now() + Duration(1));
}

bool SteadyRun::any_owing(const Assembly& assembly) {
  return std::ranges::any_of(assembly.executors, [](const auto& one) { return one->effectors().owing(); });
}

void SteadyRun::stop_process(Time since, RecordingLane* lane) {
  const auto say = [&](std::string_view text) { say_of_hold(text, clock_.now(), lane); };
  say(fmt::format("suspended by SIGTSTP; the devices have their safe commands ({:.1f} ms)",
                  seconds(clock_.now() - since) * 1e3));
  clock_.freeze();
  const std::int64_t stopped_ns = monotonic_ns();
  kill(getpid(), SIGSTOP);
  const double away_s = static_cast<double>(monotonic_ns() - stopped_ns) * 1e-9;
  clock_.thaw();
  say(fmt::format("goes on after {:.1f} s; each effector waits for new values", away_s));
}

/// No transition fires from now on, except those of a step that is being made, and the clock stands.
void SteadyRun::stand_still(RunControl& control) {
  control.pause(true);
  control.suspend();
  clock_.freeze();
  holds_ = true;
}

void SteadyRun::move_on() {
  if (!std::exchange(holds_, false)) return;
  clock_.thaw();
}

bool SteadyRun::asked_to_hold(RunControl& control) {
  if (!orders_) return false;
  if (holds_) return true;  // so the run begins
  switch (orders_->take()) {
    case RunOrders::Order::hold:
      return true;
    case RunOrders::Order::end:
      control.request_stop(RunOrders::ended, /*fault=*/false);
      return true;
    case RunOrders::Order::go_on:
      orders_->tell(RunOrders::State::runs);
      break;
    case RunOrders::Order::none:
      break;
  }
  return false;
}

/// The guardian gets its signs of life, and stops are obeyed. Returns when the run may go on or is to stop.
void SteadyRun::hold(Assembly& assembly, Securing& securing, EmergencyWatch& emergencies) {
  RunControl& control = assembly.control;
  RecordingLane* const lane = assembly.system_lane();
  if (control.stopping()) return;
  if (!holds_) stand_still(control);
  const std::int64_t since_ns = monotonic_ns();
  const auto secure = [&] {
    for (std::uint32_t instance = 0; instance < started_; ++instance)
      securing.secure(instance, {SafeReason::Kind::suspended});
  };
  secure();
  bool told = false, goes_on = false;
  while (!control.stopping()) {
    collect_secured(control, securing, lane);
    follow_emergency(emergencies, control, securing, lane);
    const Time now = clock_.now();
    const Time safe_commands = follow_safe_commands(assembly, securing, now);
    const Time beat = show_life();
    if (control.stopping()) break;
    if (!told && securing.done() && all_safe(assembly)) {
      told = true;
      say_of_hold("held: the net stands still, and the devices have their safe commands", now, lane);
      orders_->tell(RunOrders::State::held);
    }
    if (const int signal = StopSignals::pending(); signal != 0) {
      control.request_stop(StopSignals::name(signal), /*fault=*/false);
      break;
    }
    if (StopSignals::suspension_asked()) {
      move_on();
      liveness_->suspend();
      suspend(assembly, securing);
      liveness_->resume();
      stand_still(control);
      secure();
      continue;
    }
    switch (orders_->take()) {
      case RunOrders::Order::go_on:
        goes_on = true;
        break;
      case RunOrders::Order::hold:
        goes_on = false;
        if (told) orders_->tell(RunOrders::State::held);
        break;
      case RunOrders::Order::end:
        control.request_stop(RunOrders::ended, /*fault=*/false);
        continue;
      case RunOrders::Order::none:
        if (!told || !goes_on)
          await_news(std::min(
              {safe_commands, beat, securing.overdue_from(now), told ? Time::max() : now + between_looks}));
    }
    if (told && goes_on) {
      move_on();
      const double away_s = static_cast<double>(monotonic_ns() - since_ns) * 1e-9;
      say_of_hold(fmt::format("goes on after {:.1f} s; each effector waits for new values", away_s),
                  clock_.now(), lane);
      control.resume(clock_.now() + Duration(1));
      control.pause(false);
      wake_all(assembly);
      orders_->tell(RunOrders::State::runs);
      return;
    }
  }
}

bool SteadyRun::all_safe(const Assembly& assembly) {
  return std::ranges::all_of(assembly.executors,
                             [](const auto& one) { return one->effectors().unsafe().empty(); });
}

/// By a clock that goes on while that of the run stands. Returns when to show the next one.
Time SteadyRun::show_life() {
  const Time real{Duration(monotonic_ns())};
  const Time next = liveness_->show(real);
  return next == Time::max() ? next : clock_.now() + (next - real);
}

}  // namespace tessera
