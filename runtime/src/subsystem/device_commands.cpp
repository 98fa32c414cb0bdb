#include "subsystem/device_commands.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <exception>
#include <functional>
#include <utility>

#include "system/waker.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::vector<Effectors::Group> devices_of(const SubsystemParts& parts) {
  std::vector<Effectors::Group> devices;
  for (const DriverInUse& driver : parts.drivers)
    if (driver.effector) devices.push_back({driver.path, driver.first, driver.count});
  if (!devices.empty()) return devices;
  // The robot's drivers are absent: the recording takes the commands.
  for (std::size_t index = 0; index < parts.effectors.size(); ++index)
    devices.push_back({fmt::format("{}.{}", parts.path, parts.bindings.real_outputs[index].name), index, 1});
  return devices;
}

}  // namespace

DeviceCommands::DeviceCommands(const SubsystemParts& parts, const ChannelValues& inputs,
                               const Reports& reports, RunControl& control, const Clock& clock,
                               RecordingLane* lane)
    : parts_(parts),
      inputs_(inputs),
      reports_(reports),
      control_(control),
      clock_(clock),
      lane_(lane),
      life_(parts.drivers),
      limits_(parts.bindings, parts.instance->period),
      effectors_(devices_of(parts), parts.effectors, parts.bindings.real_outputs, control, clock) {}

bool DeviceCommands::open(std::string& error) {
  return life_.open(
      [this](const DriverInUse& driver) {
        for (std::size_t index = driver.first; driver.effector && index < driver.first + driver.count;
             ++index) {
          const Bindings::RealOutgoing& output = parts_.bindings.real_outputs[index];
          if (!parts_.effectors[index]->write(
                  {static_cast<const std::byte*>(output.safe.get()), output.size}))
            return false;
        }
        return true;
      },
      error);
}

// -------------------------------------------------------------------------------------------- outputs

std::optional<DeviceCommands::Failure> DeviceCommands::send(Time now, std::string_view place,
                                                            std::span<char> room) {
  have_command_ = false;
  for (const Bindings::RealOutgoing& output : parts_.bindings.real_outputs)
    if (output.finite != nullptr && !output.finite(output.value)) {
      const auto end = fmt::format_to_n(room.data(), room.size(), "output '{}' is not finite", output.name);
      return Failure{Fault::not_finite, {room.data(), std::min(end.size, room.size())}};
    }
  const RunControl::Interruptions before = control_.interruptions();
  if (const SafeReason why = why_hold(now); why.kind != SafeReason::Kind::none) {
    hold(why, place);
    return std::nullopt;
  }
  if (const std::optional<Failure> failure = keep_limits(now, room)) return failure;
  const bool was_held = std::exchange(held_, SafeReason{}).kind != SafeReason::Kind::none;
  switch (effectors_.command(now, before)) {
    case Effectors::Answer::withheld:
      give_safe_command({why_withheld(before)});
      break;
    case Effectors::Answer::refused:
      return refusal(room);
    case Effectors::Answer::taken:
      have_command_ = true;
      refused_since_ = Time::max();
      limits_.note_sent(now);
      effectors_.record(lane_);
      // At the start nothing has been interrupted.
      if (std::exchange(has_commanded_, true) && was_held)
        reports_.log(LogLevel::info, "commands go to the devices again");
  }
  return std::nullopt;
}

DeviceCommands::Failure DeviceCommands::refusal(std::span<char> room) const {
  const auto end =
      fmt::format_to_n(room.data(), room.size(), "{}: the device refused its command", effectors_.refuser());
  return {Fault::device, {room.data(), std::min(end.size, room.size())}};
}

/// A failure: a command is beyond a limit for which that is a fault.
std::optional<DeviceCommands::Failure> DeviceCommands::keep_limits(Time now, std::span<char> room) {
  const CommandLimits::Excess* const excess = limits_.apply(now);
  if (excess == nullptr) return std::nullopt;
  const auto end = excess->fault
                       ? fmt::format_to_n(room.data(), room.size(),
                                          "the command {:.6g} to real output '{}' is beyond its limits",
                                          excess->asked, excess->name)
                       : fmt::format_to_n(room.data(), room.size(),
                                          "real output '{}' is limited to {:.6g} ({:.6g} was asked for)",
                                          excess->name, excess->sent, excess->asked);
  const std::string_view line(room.data(), std::min(end.size, room.size()));
  if (excess->fault) return Failure{Fault::limit, line};
  reports_.log(LogLevel::warning, line);
  return std::nullopt;
}

// -------------------------------------------------------------------------------------------- safe commands

void DeviceCommands::give_safe_command(SafeReason why) {
  if (effectors_.none()) return;
  last_safe_ = why;
  limits_.note_safe(clock_.now());
  const bool taken = effectors_.make_safe(why, Effectors::Busy::waits);
  effectors_.record(lane_);
  if (taken) {
    refused_since_ = Time::max();
  } else if (refused_since_ == Time::max()) {
    refused_since_ = clock_.now();
    reports_.log(LogLevel::error, "a real effector refuses its safe command");
  }
}

void DeviceCommands::insist() {
  const std::int64_t until_ns = monotonic_ns() + Effectors::patience.count();
  while (effectors_.owing() && monotonic_ns() < until_ns) {
    const timespec pause{.tv_sec = 0, .tv_nsec = Effectors::between_attempts.count()};
    nanosleep(&pause, nullptr);
    static_cast<void>(effectors_.insist(last_safe_, Effectors::Busy::waits));
  }
  effectors_.record(lane_);
}

/// Repeats the safe command for devices that refused it.
void DeviceCommands::try_again(Time now) {
  if (refused_since_ == Time::max()) return;
  if (effectors_.insist(last_safe_, Effectors::Busy::waits)) {
    effectors_.record(lane_);
    refused_since_ = Time::max();
  } else if (now - refused_since_ > Effectors::patience) {
    reports_.fail_run("a real effector refuses its safe command");
  }
}

/// before: the interruptions of the run before the command, which may have begun and ended since.
SafeReason::Kind DeviceCommands::why_withheld(const RunControl::Interruptions& before) const {
  const RunControl::Interruptions now = control_.interruptions();
  if (control_.stopping()) return SafeReason::Kind::leaves;
  if (now.emergencies != before.emergencies || control_.emergency()) return SafeReason::Kind::emergency;
  if (now.suspensions != before.suspensions || control_.suspended()) return SafeReason::Kind::suspended;
  if (control_.holds_devices()) return SafeReason::Kind::other;
  return SafeReason::Kind::leaves;  // the run will stop, because the guardian has acted
}

SafeReason DeviceCommands::why_hold(Time now) const {
  if (control_.emergency()) return {SafeReason::Kind::emergency, {}};
  if (control_.holds_devices()) return {SafeReason::Kind::other, {}};
  return inputs_.why_hold(now);
}

/// The safe command stands until the reason is gone; it is reported once.
void DeviceCommands::hold(const SafeReason& why, std::string_view place) {
  give_safe_command(why);
  if (held_ == why) return;
  held_ = why;
  report_hold(why, place);
  if (why.kind != SafeReason::Kind::stale && why.kind != SafeReason::Kind::source_stalls) return;
  std::array<char, 128> room;
  ask_for_operator(describe(why, room));
}

void DeviceCommands::report_hold(const SafeReason& why, std::string_view place) {
  std::array<char, 256> text;
  const auto say = [&](auto format, const auto&... values) {
    const auto end = fmt::format_to_n(text.data(), text.size(), format, why.input, values...);
    return std::string_view(text.data(), std::min(end.size, text.size()));
  };
  switch (why.kind) {
    case SafeReason::Kind::stale:
      return reports_.report(
          Fault::stale, place,
          say(FMT_STRING("input '{}' has had no valid value for {:.6g} s"), seconds(parts_.instance->stale)));
    case SafeReason::Kind::source_stalls:
      return reports_.report(Fault::stale, place, say(FMT_STRING("the source of input '{}' stalls")));
    case SafeReason::Kind::source_ended:
      return reports_.log(
          LogLevel::info,
          say(FMT_STRING("the source of input '{}' has ended; the devices get the safe command")));
    default:  // starting: the state in which every run begins
      return;
  }
}

/// Begins an emergency stop if only an operator may end what a fault has begun.
void DeviceCommands::ask_for_operator(std::string_view why) {
  if (effectors_.none() || !parts_.instance->policies.operator_resets) return;
  std::array<char, 384> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}: {}", parts_.path, why);
  control_.begin_emergency({text.data(), std::min(end.size, text.size())});
}

void DeviceCommands::note_fault(std::string_view what) {
  effectors_.record(lane_);
  ask_for_operator(what);
}

// -------------------------------------------------------------------------------------------- while it waits

/// A failed heartbeat is a failed device; it is reported once until the heartbeat works again.
void DeviceCommands::beat(Time now, std::string_view place) {
  if (life_.next_beat() > now) return;
  std::string text = "the heartbeat of a device: an exception that is no std::exception";
  try {
    life_.beat(now, [this](const DriverInUse& driver, const std::function<void()>& call) {
      if (driver.effector)
        effectors_.alone_with(driver.first, call);
      else
        call();
    });
    heart_failed_ = false;
    return;
  } catch (const std::exception& exception) {
    text = fmt::format("the heartbeat of a device: {}", exception.what());
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (...) {
  }
  if (!std::exchange(heart_failed_, true)) reports_.report(Fault::device, place, text);
  give_safe_command({SafeReason::Kind::fault});
}

void DeviceCommands::guard(Time now, std::string_view place) {
  beat(now, place);
  if (effectors_.none()) return;
  // The safe command stands until the next command, and an input may become stale before.
  if (held_.kind == SafeReason::Kind::other && !control_.holds_devices())
    held_ = {SafeReason::Kind::starting, {}};
  if (const SafeReason why = why_hold(now); why.kind != SafeReason::Kind::none && why != held_)
    hold(why, place);
  try_again(now);
}

Time DeviceCommands::guard_deadline(Time now) const {
  using Why = SafeReason::Kind;
  if (effectors_.none()) return Time::max();
  const bool looks_again = refused_since_ != Time::max() || held_.kind == Why::other;
  const Time deadline = looks_again ? now + Effectors::between_attempts : Time::max();
  if (parts_.instance->stale == Duration::zero() || (held_.kind != Why::none && held_.kind != Why::starting))
    return deadline;
  return std::min(deadline, inputs_.stale_from());
}

}  // namespace tessera
