#include "subsystem/operations.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <exception>
#include <thread>
#include <utility>

#include "system/console.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

/// A value of another thread may be younger than this thread's last look at the clock.
[[nodiscard]] Duration age(Time stamp, Time now) { return std::max(now - stamp, Duration::zero()); }

void assign(void* to, const void* from, std::size_t size, const ValueType* type) {
  if (type == nullptr)
    std::memcpy(to, from, size);
  else
    type->assign(to, from);
}

[[nodiscard]] std::vector<Effectors::Group> devices_of(const SubsystemParts& parts) {
  std::vector<Effectors::Group> devices;
  for (const DriverInUse& driver : parts.drivers)
    if (driver.effector) devices.push_back({driver.path, driver.first, driver.count});
  if (!devices.empty()) return devices;
  // No drivers of a robot's: what is recorded takes the commands.
  for (std::size_t index = 0; index < parts.effectors.size(); ++index)
    devices.push_back({fmt::format("{}.{}", parts.path, parts.bindings.real_outputs[index].name), index, 1});
  return devices;
}

}  // namespace

Operations::Operations(SubsystemParts parts, RunControl& control, const Clock& clock, RecordingLane* lane)
    : parts_(std::move(parts)),
      devices_(parts_.drivers),
      limits_(parts_.bindings, parts_.instance->period),
      context_(parts_.subsystem->context()),
      control_(control),
      clock_(clock),
      lane_(lane),
      inputs_(parts_.bindings.inputs.size()),
      effectors_(devices_of(parts_), parts_.effectors, parts_.bindings.real_outputs, control, clock) {
  for (std::size_t index = 0; index < inputs_.size(); ++index)
    inputs_[index].arrival = parts_.bindings.inputs[index].arrival;
  for (const PortLink& port : parts_.ports) {
    if (port.side != Side::receive) continue;
    inputs_[port.buffer].used = true;
    inputs_[port.buffer].source = port.peer;
  }
  if (!effectors_.none()) find_received_inputs();
  if (!parts_.instance->policies.non_finite_allowed)
    for (const Bindings::Outgoing& output : parts_.bindings.outputs)
      if (output.finite != nullptr) checked_.push_back(&output);
  context_.attach(this);
  context_.period = parts_.instance->period;
}

/// Runs user code; false when it threw. Nothing a user throws gets past here. activity: in front of what was
/// thrown.
template <class Code>
bool Operations::survives(Fault fault, std::uint16_t behaviour, std::string_view activity, Code&& code) {
  try {
    std::forward<Code>(code)();
    return true;
  } catch (const abi::__forced_unwind&) {  // the thread ends
    throw;
  } catch (const std::exception& exception) {
    fail_in(fault, behaviour, activity, exception.what());
  } catch (...) {
    fail_in(fault, behaviour, activity, "an exception that is no std::exception");
  }
  return false;
}

void Operations::fail_in(Fault fault, std::uint16_t behaviour, std::string_view activity,
                         std::string_view what) {
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}{}", activity, what);
  fail(fault, behaviour, {text.data(), std::min(end.size, text.size())});
}

void Operations::fail(Fault fault, std::uint16_t behaviour, std::string_view what) {
  give_safe_command({SafeReason::Kind::fault});  // before anything is said
  report(fault, place_of_call(behaviour), what);
  effectors_.record(lane_);
  ask_for_operator(what);
  failed_ = true;
  parts_.subsystem->restore_outputs();
}

/// A place that reads is one of the behaviour that its name begins with: "follow.rcv.line.in".
void Operations::find_received_inputs() {
  const SubsystemNet& net = *parts_.instance->net;
  received_.resize(net.behaviours.size());
  for (const Place& place : net.places) {
    if (place.does.kind != Does::Kind::read) continue;
    const std::string_view owner = place.name.substr(0, place.name.find('.'));
    for (std::size_t behaviour = 0; behaviour < net.behaviours.size(); ++behaviour)
      for (std::size_t port = 0; port < net.ports.size(); ++port)
        if (net.behaviours[behaviour].name == owner && net.ports[port].name == place.does.subject)
          received_[behaviour].push_back(parts_.ports[port].buffer);
  }
}

/// Where the token stands while that behaviour's transition function runs.
std::string_view Operations::place_of_call(std::uint16_t behaviour) const {
  const SubsystemNet& net = *parts_.instance->net;
  const std::string_view name = net.behaviours[behaviour].name;
  const auto place = std::find_if(net.places.begin(), net.places.end(), [&](const Place& one) {
    return one.does.kind == Does::Kind::call && one.does.subject == name;
  });
  return place == net.places.end() ? name : place->name;
}

// -------------------------------------------------------------------------------------------- transition
// function

void Operations::take_changes(Time now) {
  if (parts_.changes == nullptr) return;
  parts_.changes->take(parts_.index, [&](const std::string& change) {
    if (lane_ != nullptr) lane_->text(Event::Kind::parameter, now, 0, change);
    console::print(LogLevel::info, now, "tessera", change);
  });
}

void Operations::start_call(std::uint16_t behaviour, Time now, std::uint64_t missed) {
  take_changes(now);
  behaviour_ = behaviour;
  called_at_ = now;
  failed_ = false;
  ++calls_;
  if (!received_.empty())
    for (const std::uint32_t input : received_[behaviour]) inputs_[input].awaited = true;
  parts_.subsystem->keep_outputs();
  context_.now = now;
  context_.iteration = iteration_;
  if (parts_.values != nullptr) parts_.values->call(now, behaviour, iteration_);
  if (missed > 0) return fail_late(missed);
  if (!parts_.receptors.empty() &&
      !survives(Fault::device, behaviour, "reading a real receptor: ", [&] { read_receptors(now); }))
    return;
  refresh_ages(now);
  static_cast<void>(survives(Fault::exception, behaviour, "", [&] { parts_.subsystem->call(behaviour); }));
}

void Operations::fail_late(std::uint64_t missed) {
  std::array<char, 128> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "its work made it miss {} instant{} of its rate", missed,
                       missed == 1 ? "" : "s");
  fail(Fault::overrun, behaviour_, {text.data(), std::min(end.size, text.size())});
}

void Operations::finish_call(Time now) {
  // Real inputs stay fresh for the conditions of this iteration; the next one reads them again.
  for (const Bindings::Incoming& input : parts_.bindings.inputs) input.arrival->fresh = false;
  beat(now, place_of_call(behaviour_));
  check_watchdog(now);
  check_outputs();
  if (!effectors_.none() && !failed_)
    static_cast<void>(
        survives(Fault::device, behaviour_, "writing a real effector: ", [&] { write_effectors(now); }));
  if (parts_.values != nullptr) parts_.values->outputs(now);
}

void Operations::check_watchdog(Time now) {
  const Duration allowed = parts_.instance->policies.watchdog;
  if (allowed == Duration::zero() || failed_ || now - called_at_ <= allowed) return;
  std::array<char, 128> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "took {:.6g} s, and its watchdog allows {:.6g} s",
                       seconds(now - called_at_), seconds(allowed));
  fail(Fault::stall, behaviour_, {text.data(), std::min(end.size, text.size())});
}

void Operations::check_outputs() {
  if (failed_) return;
  for (const Bindings::Outgoing* output : checked_)
    if (!output->finite(output->value)) return fail_not_finite(*output);
}

void Operations::fail_not_finite(const Bindings::Outgoing& output) {
  std::array<char, 256> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "output '{}' is not finite", output.name);
  fail(Fault::not_finite, behaviour_, {text.data(), std::min(end.size, text.size())});
}

void Operations::read_receptors(Time now) {
  for (std::size_t index = 0; index < parts_.receptors.size(); ++index) {
    const Bindings::Incoming& input = parts_.bindings.real_inputs[index];
    Arrival& arrival = *input.arrival;
    arrival.fresh = read_receptor(index, now);
    if (!arrival.fresh) continue;
    arrival.valid = true;
    arrival.stamp = now;
  }
}

/// Records what came of it.
bool Operations::read_receptor(std::size_t index, Time now) {
  using Reading = ValueRecorder::Reading;
  const Bindings::Incoming& input = parts_.bindings.real_inputs[index];
  const std::span<std::byte> value(static_cast<std::byte*>(input.value), input.size);
  if (parts_.values == nullptr) return parts_.receptors[index]->read(value);
  Reading reading = Reading::failed;
  try {
    reading = parts_.receptors[index]->read(value) ? Reading::value : Reading::silent;
  } catch (...) {
    parts_.values->real_input(index, now, reading);
    throw;
  }
  parts_.values->real_input(index, now, reading);
  return reading == Reading::value;
}

void Operations::write_effectors(Time now) {
  for (const Bindings::RealOutgoing& output : parts_.bindings.real_outputs)
    if (output.finite != nullptr && !output.finite(output.value)) return fail_not_finite(output);
  if (const SafeReason why = why_hold(now); why.kind != SafeReason::Kind::none)
    return hold(why, place_of_call(behaviour_));
  if (!keep_limits(now)) return;
  const bool was_held = std::exchange(held_, SafeReason{}).kind != SafeReason::Kind::none;
  switch (effectors_.command(now)) {
    case Effectors::Answer::withheld:
      return give_safe_command({control_.stopping()    ? SafeReason::Kind::leaves
                                : control_.emergency() ? SafeReason::Kind::emergency
                                                       : SafeReason::Kind::suspended});
    case Effectors::Answer::refused:
      return fail(Fault::device, behaviour_, "a real effector refused its command");
    case Effectors::Answer::taken:
      refused_since_ = Time::max();
      limits_.note_sent(now);
      effectors_.record(lane_);
      if (was_held) log(LogLevel::info, "commands go to the devices again");
  }
}

/// false: a command is beyond a limit for which that is a fault.
bool Operations::keep_limits(Time now) {
  const CommandLimits::Excess* const excess = limits_.apply(now);
  if (excess == nullptr) return true;
  std::array<char, 256> text;
  const auto end = excess->fault
                       ? fmt::format_to_n(text.data(), text.size(),
                                          "the command {:.6g} to real output '{}' is beyond its limits",
                                          excess->asked, excess->name)
                       : fmt::format_to_n(text.data(), text.size(),
                                          "real output '{}' is limited to {:.6g} ({:.6g} was asked for)",
                                          excess->name, excess->sent, excess->asked);
  const std::string_view line(text.data(), std::min(end.size, text.size()));
  if (excess->fault)
    fail(Fault::limit, behaviour_, line);
  else
    log(LogLevel::warning, line);
  return !excess->fault;
}

// -------------------------------------------------------------------------------------------- channels

void Operations::write(std::uint32_t port, std::uint16_t slot, Time now) {
  const PortLink& link = parts_.ports[port];
  const Bindings::Outgoing& output = parts_.bindings.outputs[link.buffer];
  SharedChannel::Memory& memory = link.channel->memory(slot);
  assign(memory.bytes.data(), output.value, output.size, output.type);
  memory.stamp = now;
  memory.valid = !failed_;
  memory.sequence = link.channel->next_sequence();
  output.departure->stamp = now;
}

/// A slot may hold a value that was read before, or an older one: only a newer one is fresh.
void Operations::read(std::uint32_t port, std::uint16_t slot, Time now) {
  const PortLink& link = parts_.ports[port];
  const Bindings::Incoming& input = parts_.bindings.inputs[link.buffer];
  InputState& state = inputs_[link.buffer];
  input.arrival->timed_out = false;
  const SharedChannel::Memory& memory = link.channel->memory(slot);
  if (memory.sequence == 0 || memory.sequence == state.sequence) return;
  assign(input.value, memory.bytes.data(), input.size, input.type);
  const bool newer = memory.sequence > state.newest;
  input.arrival->fresh = input.arrival->fresh || newer;
  state.newest = std::max(state.newest, memory.sequence);
  state.sequence = memory.sequence;
  if (memory.valid && memory.stamp >= control_.valid_from()) {
    state.last_valid = memory.stamp;
    state.known = true;
  }
  input.arrival->valid = memory.valid;
  input.arrival->stamp = memory.stamp;
  input.arrival->age = age(memory.stamp, now);
  if (parts_.values != nullptr) parts_.values->input(link.buffer, now, newer);
}

void Operations::note_timeout(std::uint32_t port) {
  const PortLink& link = parts_.ports[port];
  if (link.side == Side::receive)
    parts_.bindings.inputs[link.buffer].arrival->timed_out = true;
  else
    parts_.bindings.outputs[link.buffer].departure->timed_out = true;
}

void Operations::note_answer(std::uint32_t port) {
  const PortLink& link = parts_.ports[port];
  if (link.side == Side::send) parts_.bindings.outputs[link.buffer].departure->timed_out = false;
}

void Operations::refresh_ages(Time now) {
  for (const InputState& input : inputs_)
    if (input.sequence != 0) input.arrival->age = age(input.arrival->stamp, now);
  for (const Bindings::Incoming& input : parts_.bindings.real_inputs)
    if (input.arrival->valid) input.arrival->age = now - input.arrival->stamp;
}

// -------------------------------------------------------------------------------------------- conditions

Outcome Operations::decide(std::uint16_t behaviour, Time now) {
  refresh_ages(now);
  Outcome outcome = Outcome::error;
  if (!survives(Fault::exception, behaviour,
                "a condition: ", [&] { outcome = parts_.subsystem->decide(behaviour, failed_); }))
    outcome = parts_.subsystem->decide(behaviour, /*failed=*/true);  // no named condition has held
  if (failed_) outcome = Outcome::error;
  accept_outcome(outcome);
  return outcome;
}

void Operations::accept_outcome(Outcome outcome) {
  erroneous_ = outcome == Outcome::error;
  if (erroneous_) ++errors_;
}

int Operations::route(std::uint16_t behaviour, Time now) {
  refresh_ages(now);
  int entry = no_entry;
  const bool known = survives(Fault::exception, behaviour, "a condition of `next`: ", [&] {
    entry = parts_.subsystem->route(behaviour, erroneous_);
  });
  return known ? entry : unknown_entry;
}

// -------------------------------------------------------------------------------------------- safe commands

void Operations::give_safe_command(SafeReason why) {
  if (effectors_.none()) return;
  last_safe_ = why;
  limits_.note_safe(clock_.now());
  const bool taken = effectors_.make_safe(why, Effectors::Busy::waits);
  effectors_.record(lane_);
  if (taken) {
    refused_since_ = Time::max();
  } else if (refused_since_ == Time::max()) {
    refused_since_ = clock_.now();
    log(LogLevel::error, "a real effector refuses its safe command");
  }
}

void Operations::insist() {
  const std::int64_t until_ns = monotonic_ns() + Effectors::patience.count();
  while (effectors_.owing() && monotonic_ns() < until_ns) {
    const timespec pause{.tv_sec = 0, .tv_nsec = Effectors::between_attempts.count()};
    nanosleep(&pause, nullptr);
    static_cast<void>(effectors_.insist(last_safe_, Effectors::Busy::waits));
  }
  effectors_.record(lane_);
}

/// Where the safe command was refused.
void Operations::try_again(Time now) {
  if (refused_since_ == Time::max()) return;
  if (effectors_.insist(last_safe_, Effectors::Busy::waits)) {
    effectors_.record(lane_);
    refused_since_ = Time::max();
  } else if (now - refused_since_ > Effectors::patience) {
    std::array<char, 512> reason;
    const auto end = fmt::format_to_n(reason.data(), reason.size(),
                                      "{}: a real effector refuses its safe command", parts_.path);
    control_.request_stop({reason.data(), std::min(end.size, reason.size())}, /*fault=*/true);
  }
}

bool Operations::open_devices(std::string& error) {
  return devices_.open(
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

/// A heart that fails is a device that fails; said once until it beats again.
void Operations::beat(Time now, std::string_view place) {
  if (devices_.next_beat() > now) return;
  std::string text = "the heartbeat of a device: an exception that is no std::exception";
  try {
    devices_.beat(now, [this](const DriverInUse& driver, const std::function<void()>& call) {
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
  if (!std::exchange(heart_failed_, true)) report(Fault::device, place, text);
  give_safe_command({SafeReason::Kind::fault});
}

SafeReason Operations::why_hold(Time now) const {
  using Why = SafeReason::Kind;
  if (control_.emergency()) return {Why::emergency, {}};
  const Duration stale = parts_.instance->stale;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    const InputState& input = inputs_[index];
    if (!input.used) continue;
    const std::string_view name = parts_.bindings.inputs[index].name;
    if (input.source != UINT32_MAX) {
      if (control_.has_ended(input.source)) return {Why::source_ended, name};
      if (control_.is_stalled(input.source)) return {Why::source_stalls, name};
    }
    if (stale > Duration::zero() && now - input.last_valid > stale) return {Why::stale, name};
    if (input.awaited && (!input.known || input.last_valid < control_.valid_from()))
      return {Why::starting, name};
  }
  return {};
}

/// The safe command stands until the reason is gone; said once.
void Operations::hold(const SafeReason& why, std::string_view place) {
  give_safe_command(why);
  if (held_ == why) return;
  held_ = why;
  report_hold(why, place);
  if (why.kind != SafeReason::Kind::stale && why.kind != SafeReason::Kind::source_stalls) return;
  std::array<char, 128> room;
  ask_for_operator(describe(why, room));
}

/// Where only an operator may end what a fault has begun.
void Operations::ask_for_operator(std::string_view why) {
  if (effectors_.none() || !parts_.instance->policies.operator_resets) return;
  std::array<char, 384> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}: {}", parts_.path, why);
  control_.begin_emergency({text.data(), std::min(end.size, text.size())});
}

void Operations::report_hold(const SafeReason& why, std::string_view place) {
  std::array<char, 256> text;
  const auto say = [&](auto format, const auto&... values) {
    const auto end = fmt::format_to_n(text.data(), text.size(), format, why.input, values...);
    return std::string_view(text.data(), std::min(end.size, text.size()));
  };
  switch (why.kind) {
    case SafeReason::Kind::stale:
      return report(
          Fault::stale, place,
          say(FMT_STRING("input '{}' has had no valid value for {:.6g} s"), seconds(parts_.instance->stale)));
    case SafeReason::Kind::source_stalls:
      return report(Fault::stale, place, say(FMT_STRING("the source of input '{}' stalls")));
    case SafeReason::Kind::source_ended:
      return log(LogLevel::info,
                 say(FMT_STRING("the source of input '{}' has ended; the devices get the safe command")));
    default:  // starting: as every run begins
      return;
  }
}

void Operations::guard_effectors(Time now, std::string_view place) {
  beat(now, place);
  if (effectors_.none()) return;
  if (const SafeReason why = why_hold(now); why.kind != SafeReason::Kind::none && why != held_)
    hold(why, place);
  try_again(now);
}

Time Operations::guard_deadline(Time now) const {
  using Why = SafeReason::Kind;
  if (effectors_.none()) return Time::max();
  Time deadline = refused_since_ == Time::max() ? Time::max() : now + Effectors::between_attempts;
  if (parts_.instance->stale == Duration::zero() || (held_.kind != Why::none && held_.kind != Why::starting))
    return deadline;
  for (const InputState& input : inputs_)
    if (input.used) deadline = std::min(deadline, input.last_valid + parts_.instance->stale + Duration(1));
  return deadline;
}

// -------------------------------------------------------------------------------------------- services

void Operations::log(LogLevel level, std::string_view text) {
  while (control_.abandoned()) std::this_thread::sleep_for(std::chrono::seconds(1));
  const Time now = clock_.now();
  console::print(level, now, parts_.path, text);
  if (lane_ != nullptr) lane_->text(Event::Kind::log, now, static_cast<std::uint32_t>(level), text);
}

void Operations::report(Fault fault, std::string_view place, std::string_view what,
                        RecordingLane* lane) const {
  const Time now = clock_.now();
  const std::string_view effect = parts_.effectors.empty() ? "" : "; the devices get the safe command";
  std::array<char, 768> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "{}.{}: {}{}", parts_.path, place, what, effect);
  const std::string_view line(text.data(), std::min(end.size, text.size()));
  if (lane != nullptr) lane->text(Event::Kind::fault, now, static_cast<std::uint32_t>(fault), line);
  const std::size_t path = std::min(parts_.path.size() + 1 + place.size(), line.size());
  console::print(LogLevel::error, now, line.substr(0, path), line.substr(std::min(path + 2, line.size())));
}

void Operations::report_stall(std::uint16_t behaviour, RecordingLane* lane) const {
  std::array<char, 128> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "has not returned for {:.6g} s",
                                    seconds(parts_.instance->policies.watchdog));
  report(Fault::stall, place_of_call(behaviour), {text.data(), std::min(end.size, text.size())}, lane);
}

void Operations::broken(std::string_view assertion) {
  report(Fault::assertion, place_of_call(behaviour_), assertion);
  std::array<char, 512> reason;
  const auto end =
      fmt::format_to_n(reason.data(), reason.size(), "{}: broken assertion: {}", parts_.path, assertion);
  control_.request_stop({reason.data(), std::min(end.size, reason.size())}, /*fault=*/true);
}

void Operations::emergency_stop(std::string_view reason) {
  std::array<char, 512> text;
  const auto end = fmt::format_to_n(text.data(), text.size(), "{}: {}", parts_.path, reason);
  control_.begin_emergency({text.data(), std::min(end.size, text.size())});
}

void Operations::stop(std::string_view reason) { control_.request_stop(reason, /*fault=*/false); }

}  // namespace tessera
