#include "operations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <utility>

#include "console.hpp"

namespace tessera {
namespace {

/// One thread at a time writes to the effectors of a subsystem. Others come only when it stalls, so this
/// costs no system call as a rule.
class DeviceLock {
 public:
  explicit DeviceLock(std::atomic_flag& in_use) : in_use_(in_use) {
    while (in_use_.test_and_set(std::memory_order_acquire)) in_use_.wait(true, std::memory_order_relaxed);
  }
  DeviceLock(const DeviceLock&) = delete;
  DeviceLock& operator=(const DeviceLock&) = delete;
  ~DeviceLock() {
    in_use_.clear(std::memory_order_release);
    in_use_.notify_one();
  }

 private:
  std::atomic_flag& in_use_;
};

/// A value of another thread may be younger than this thread's last look at the clock.
[[nodiscard]] Duration age(Time stamp, Time now) { return std::max(now - stamp, Duration::zero()); }

void assign(void* to, const void* from, std::size_t size, const ValueType* type) {
  if (type == nullptr)
    std::memcpy(to, from, size);
  else
    type->assign(to, from);
}

}  // namespace

Operations::Operations(SubsystemParts parts, RunControl& control, const Clock& clock, RecordingLane* lane)
    : parts_(std::move(parts)),
      context_(parts_.subsystem->context()),
      control_(control),
      clock_(clock),
      lane_(lane),
      inputs_(parts_.bindings.inputs.size()) {
  for (std::size_t index = 0; index < inputs_.size(); ++index)
    inputs_[index].arrival = parts_.bindings.inputs[index].arrival;
  for (const PortLink& port : parts_.ports) {
    if (port.side != Side::receive) continue;
    inputs_[port.buffer].used = true;
    inputs_[port.buffer].source = port.peer;
  }
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
  report(fault, place_of_call(behaviour), what);
  failed_ = true;
  parts_.subsystem->restore_outputs();
  give_safe_command();
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

void Operations::start_call(std::uint16_t behaviour, Time now) {
  behaviour_ = behaviour;
  called_at_ = now;
  failed_ = false;
  ++calls_;
  parts_.subsystem->keep_outputs();
  context_.now = now;
  context_.iteration = iteration_;
  if (parts_.values != nullptr) parts_.values->call(now, behaviour, iteration_);
  if (!parts_.receptors.empty() &&
      !survives(Fault::device, behaviour, "reading a real receptor: ", [&] { read_receptors(now); }))
    return;
  refresh_ages(now);
  static_cast<void>(survives(Fault::exception, behaviour, "", [&] { parts_.subsystem->call(behaviour); }));
}

void Operations::finish_call(Time now) {
  // Real inputs stay fresh for the conditions of this iteration; the next one reads them again.
  for (const Bindings::Incoming& input : parts_.bindings.inputs) input.arrival->fresh = false;
  check_watchdog(now);
  check_outputs();
  if (!parts_.effectors.empty() && !failed_) {
    refused_ = false;
    static_cast<void>(
        survives(Fault::device, behaviour_, "writing a real effector: ", [&] { write_effectors(now); }));
    if (refused_) fail(Fault::device, behaviour_, "a real effector refused its command");
  }
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
  if (const Hold why = why_hold(now); why.kind != Hold::Kind::none)
    return hold(why, place_of_call(behaviour_));
  if (control_.stopping()) return give_safe_command();
  if (std::exchange(held_safe_, false)) log(LogLevel::info, "commands go to the devices again");
  const DeviceLock lock(devices_in_use_);
  for (std::size_t index = 0; index < parts_.effectors.size(); ++index) {
    const Bindings::RealOutgoing& output = parts_.bindings.real_outputs[index];
    if (!parts_.effectors[index]->write({static_cast<const std::byte*>(output.value), output.size})) {
      refused_ = true;
      return;
    }
    output.departure->stamp = now;
  }
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
  if (memory.valid) state.last_valid = memory.stamp;
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

void Operations::give_safe_command() {
  if (parts_.effectors.empty()) return;
  const DeviceLock lock(devices_in_use_);
  if (!write_safe_command()) log(LogLevel::error, "a real effector refused its safe command");
}

bool Operations::give_safe_command_from_outside() {
  if (parts_.effectors.empty()) return true;
  if (devices_in_use_.test_and_set(std::memory_order_acquire)) return false;
  const bool taken = write_safe_command();
  devices_in_use_.clear(std::memory_order_release);
  devices_in_use_.notify_one();
  return taken;
}

bool Operations::write_safe_command() {
  bool taken = true;
  for (std::size_t index = 0; index < parts_.effectors.size(); ++index) {
    const Bindings::RealOutgoing& output = parts_.bindings.real_outputs[index];
    try {
      taken =
          parts_.effectors[index]->write({static_cast<const std::byte*>(output.safe.get()), output.size}) &&
          taken;
    } catch (...) {  // the other devices must get theirs
      taken = false;
    }
  }
  return taken;
}

Operations::Hold Operations::why_hold(Time now) const {
  const Duration stale = parts_.instance->stale;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    const InputState& input = inputs_[index];
    if (!input.used) continue;
    if (input.source != UINT32_MAX) {
      if (control_.has_ended(input.source)) return {Hold::Kind::ended, index};
      if (control_.is_stalled(input.source)) return {Hold::Kind::stalled, index};
    }
    if (stale > Duration::zero() && now - input.last_valid > stale) return {Hold::Kind::stale, index};
  }
  return {};
}

/// The safe command stands until the reason is gone; said once.
void Operations::hold(const Hold& why, std::string_view place) {
  if (!std::exchange(held_safe_, true)) {
    std::array<char, 256> text;
    const std::string_view input = parts_.bindings.inputs[why.input].name;
    const auto say = [&](auto format, const auto&... values) {
      const auto end = fmt::format_to_n(text.data(), text.size(), format, input, values...);
      return std::string_view(text.data(), std::min(end.size, text.size()));
    };
    switch (why.kind) {
      case Hold::Kind::stale:
        report(Fault::stale, place,
               say(FMT_STRING("input '{}' has had no valid value for {:.6g} s"),
                   seconds(parts_.instance->stale)));
        break;
      case Hold::Kind::stalled:
        report(Fault::stale, place, say(FMT_STRING("the source of input '{}' stalls")));
        break;
      case Hold::Kind::ended:
        log(LogLevel::info,
            say(FMT_STRING("the source of input '{}' has ended; the devices get the safe command")));
        break;
      case Hold::Kind::none:
        break;
    }
  }
  give_safe_command();
}

void Operations::guard_effectors(Time now, std::string_view place) {
  if (parts_.effectors.empty() || held_safe_) return;
  if (const Hold why = why_hold(now); why.kind != Hold::Kind::none) hold(why, place);
}

Time Operations::guard_deadline() const {
  Time deadline = Time::max();
  if (parts_.effectors.empty() || held_safe_ || parts_.instance->stale == Duration::zero()) return deadline;
  for (const InputState& input : inputs_)
    if (input.used) deadline = std::min(deadline, input.last_valid + parts_.instance->stale + Duration(1));
  return deadline;
}

// -------------------------------------------------------------------------------------------- services

void Operations::log(LogLevel level, std::string_view text) {
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

void Operations::stop(std::string_view reason) { control_.request_stop(reason, /*fault=*/false); }

}  // namespace tessera
