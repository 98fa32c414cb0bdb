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
  for (const PortLink& port : parts_.ports) {
    if (port.side != Side::receive) continue;
    inputs_[port.buffer].used = true;
    inputs_[port.buffer].source = port.peer;
  }
  context_.attach(this);
  context_.period = parts_.instance->period;
}

/// Runs user code; false when it threw. Nothing a user throws gets past here.
template <class Code>
bool Operations::survives(std::uint16_t behaviour, std::string_view activity, Code&& code) {
  std::array<char, 512> text;
  const auto describe = [&](std::string_view what) {
    const std::string_view name = parts_.instance->net->behaviours[behaviour].name;
    const auto end = fmt::format_to_n(text.data(), text.size(), "{}{}: {}", name, activity, what);
    fail({text.data(), std::min(end.size, text.size())});
  };
  try {
    std::forward<Code>(code)();
    return true;
  } catch (const std::exception& exception) {
    describe(exception.what());
  } catch (...) {
    describe("an exception that is no std::exception");
  }
  return false;
}

void Operations::fail(std::string_view what) {
  log(LogLevel::error, what);
  failed_ = true;
  parts_.subsystem->restore_outputs();
  give_safe_command();
}

// -------------------------------------------------------------------------------------------- transition
// function

void Operations::start_call(std::uint16_t behaviour, Time now) {
  behaviour_ = behaviour;
  failed_ = false;
  ++calls_;
  parts_.subsystem->keep_outputs();
  context_.now = now;
  context_.iteration = iteration_;
  if (!parts_.receptors.empty() &&
      !survives(behaviour, " (reading a real receptor)", [&] { read_receptors(now); }))
    return;
  refresh_ages(now);
  static_cast<void>(survives(behaviour, "", [&] { parts_.subsystem->call(behaviour); }));
}

void Operations::finish_call(Time now) {
  // Real inputs stay fresh for the conditions of this iteration; the next one reads them again.
  for (const Bindings::Incoming& input : parts_.bindings.inputs) input.arrival->fresh = false;
  if (!parts_.effectors.empty() && !failed_)
    static_cast<void>(survives(behaviour_, " (writing a real effector)", [&] { write_effectors(now); }));
}

void Operations::read_receptors(Time now) {
  for (std::size_t index = 0; index < parts_.receptors.size(); ++index) {
    const Bindings::Incoming& input = parts_.bindings.real_inputs[index];
    Arrival& arrival = *input.arrival;
    arrival.fresh = parts_.receptors[index]->read({static_cast<std::byte*>(input.value), input.size});
    if (!arrival.fresh) continue;
    arrival.valid = true;
    arrival.stamp = now;
  }
}

void Operations::write_effectors(Time now) {
  if (!outputs_are_finite())
    return fail("a real output is not a finite number; the device got the safe command");
  if (must_be_safe(now)) {
    held_safe_ = true;
    return give_safe_command();
  }
  held_safe_ = false;
  for (std::size_t index = 0; index < parts_.effectors.size(); ++index) {
    const Bindings::RealOutgoing& output = parts_.bindings.real_outputs[index];
    if (parts_.effectors[index]->write({static_cast<const std::byte*>(output.value), output.size}))
      output.departure->stamp = now;
    else
      return fail("a real effector refused its command");
  }
}

bool Operations::outputs_are_finite() const {
  return std::all_of(parts_.bindings.real_outputs.begin(), parts_.bindings.real_outputs.end(),
                     [](const Bindings::RealOutgoing& output) {
                       return output.finite == nullptr || output.finite(output.value);
                     });
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
  input.arrival->fresh = input.arrival->fresh || memory.sequence > state.newest;
  state.newest = std::max(state.newest, memory.sequence);
  state.sequence = memory.sequence;
  if (memory.valid) state.last_valid = memory.stamp;
  input.arrival->valid = memory.valid;
  input.arrival->stamp = memory.stamp;
  input.arrival->age = age(memory.stamp, now);
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
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    Arrival& arrival = *parts_.bindings.inputs[index].arrival;
    if (inputs_[index].sequence != 0) arrival.age = age(arrival.stamp, now);
  }
  for (const Bindings::Incoming& input : parts_.bindings.real_inputs)
    if (input.arrival->valid) input.arrival->age = now - input.arrival->stamp;
}

// -------------------------------------------------------------------------------------------- conditions

Outcome Operations::decide(std::uint16_t behaviour, Time now) {
  refresh_ages(now);
  Outcome outcome = Outcome::error;
  if (!survives(behaviour, " (its conditions)",
                [&] { outcome = parts_.subsystem->decide(behaviour, failed_); }))
    outcome = Outcome::error;
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
  const bool known = survives(behaviour, " (its conditions of `next`)",
                              [&] { entry = parts_.subsystem->route(behaviour, erroneous_); });
  return known ? entry : unknown_entry;
}

// -------------------------------------------------------------------------------------------- safe commands

void Operations::give_safe_command() {
  for (std::size_t index = 0; index < parts_.effectors.size(); ++index) {
    const Bindings::RealOutgoing& output = parts_.bindings.real_outputs[index];
    bool taken = false;
    try {
      taken = parts_.effectors[index]->write({static_cast<const std::byte*>(output.safe.get()), output.size});
    } catch (...) {  // the other devices must get theirs
    }
    if (!taken) log(LogLevel::error, "a real effector refused its safe command");
  }
}

bool Operations::must_be_safe(Time now) const {
  const Duration stale = parts_.instance->stale;
  return std::any_of(inputs_.begin(), inputs_.end(), [&](const InputState& input) {
    if (!input.used) return false;
    if (input.source != UINT32_MAX && control_.has_ended(input.source)) return true;
    return stale > Duration::zero() && now - input.last_valid > stale;
  });
}

void Operations::guard_effectors(Time now) {
  if (parts_.effectors.empty() || held_safe_ || !must_be_safe(now)) return;
  held_safe_ = true;
  give_safe_command();
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

void Operations::stop(std::string_view reason) { control_.request_stop(reason, /*fault=*/false); }

}  // namespace tessera
