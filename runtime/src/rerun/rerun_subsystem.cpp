#include "rerun/rerun_subsystem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <utility>

namespace tessera {
namespace {

using Entry = Recording::Entry;

[[nodiscard]] std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

[[nodiscard]] std::string bytes_of(const ValueSink& value) {
  if (value.whole())
    return std::string(reinterpret_cast<const char*>(value.bytes().data()), value.bytes().size());
  const std::array numbers{value.size(), value.hash()};
  return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
}

/// The fault that made the recorded iteration fail; nullptr: it did not fail.
[[nodiscard]] const Entry* recorded_failure(const RecordedMoment& moment) {
  for (const Entry* entry : moment.rest) {
    if (entry->event.kind() != Event::Kind::fault || entry->event.is_told_fault()) continue;
    const Fault fault = entry->event.fault();
    if (fault == Fault::exception || fault == Fault::not_finite || fault == Fault::device ||
        fault == Fault::stall || fault == Fault::overrun || fault == Fault::limit || fault == Fault::overtime)
      return entry;
  }
  return nullptr;
}

/// Whether the fault has a cause outside of user code, so that it does not happen again.
[[nodiscard]] bool comes_from_outside(const Entry& fault) {
  const Fault kind = fault.event.fault();
  return kind == Fault::device || kind == Fault::stall || kind == Fault::overtime;
}

/// Accepts every command. Refusals come from the recording.
class RecordedEffector final : public RealEffector {
  bool write(std::span<const std::byte>) override { return true; }
};

}  // namespace

/// Returns the recorded values of a real input.
class RerunSubsystem::RecordedReceptor final : public RealReceptor {
 public:
  RecordedReceptor(const Held& held, const ValueEncoding& encoding) : held_(held), encoding_(encoding) {}
  bool read(std::span<std::byte> value) override {
    if (held_.failed) throw std::runtime_error("it threw in the recorded run");
    if (held_.silent) return false;
    return encoding_.take(value.data(), as_bytes(held_.bytes));
  }

 private:
  const Held& held_;
  const ValueEncoding& encoding_;
};

void RerunSubsystem::Held::take(const ValueEvent& value) {
  silent = value.has(ValueFlags::silent);
  failed = value.has(ValueFlags::failed);
  if (silent || failed || value.has(ValueFlags::same)) return;
  bytes = value.bytes;
  hashed = value.has(ValueFlags::hashed);
}

RerunSubsystem::RerunSubsystem(LoosePart& part, std::uint32_t first_buffer, const Recording& recording,
                               RunControl& control, const Clock& clock)
    : recording_(recording),
      plan_(std::move(part.plan)),
      first_transition_(part.first_transition),
      first_buffer_(first_buffer),
      held_(count_buffers(part.parts.bindings)),
      operations_(with_devices(std::move(part.parts)), control, clock, nullptr),
      reads_(held_.size()) {
  report_.path = parts().path;
  std::uint32_t number = first_buffer;
  for_buffers(parts().bindings, [&](Recording::Direction direction, const auto& buffer) {
    const bool out =
        direction == Recording::Direction::output || direction == Recording::Direction::real_output;
    if (out && buffer.encoding != nullptr) {
      const std::size_t kept = std::min<std::uint64_t>(buffer.encoding->most, recording.value_limit);
      outputs_.push_back({number, buffer.value, buffer.encoding, ValueSink(kept),
                          ValueLayout::parse(recording.buffers[number].type)});
      report_.outputs.push_back({recording.buffers[number].path, 0});
    }
    ++number;
  });
}

SubsystemParts RerunSubsystem::with_devices(SubsystemParts parts) const {
  const Bindings& bindings = parts.bindings;
  const std::size_t before = bindings.inputs.size() + bindings.outputs.size();
  for (std::size_t index = 0; index < bindings.real_inputs.size(); ++index)
    parts.receptors.push_back(
        std::make_unique<RecordedReceptor>(held_[before + index], *bindings.real_inputs[index].encoding));
  for (std::size_t index = 0; index < bindings.real_outputs.size(); ++index)
    parts.effectors.push_back(std::make_unique<RecordedEffector>());
  return parts;
}

void RerunSubsystem::play(const RecordedMoment& moment) {
  at_ = Time(Duration(moment.head->event.time_ns));
  if (moment.head->event.kind() == Event::Kind::parameter)
    set_parameter(moment.head->text);
  else if (moment.head->event.kind() == Event::Kind::call)
    call(moment);
  else
    fire(moment);
}

/// "robot.control.v=0.3"
void RerunSubsystem::set_parameter(const std::string& change) {
  finish_call();
  const std::size_t equals = change.find('=');
  if (equals == std::string::npos) return differ("a parameter", change, "nothing that can be set");
  const std::pair<std::string, std::string> one{change.substr(0, equals), change.substr(equals + 1)};
  const ParameterOwner owner{parts().path, parts().bindings.parameters};
  std::string wrong;
  if (!set_parameters({&owner, 1}, {&one, 1}, wrong)) differ("a parameter", change, wrong);
}

void RerunSubsystem::call(const RecordedMoment& moment) {
  iteration_ = moment.head->event.version;
  const auto behaviour = static_cast<std::uint16_t>(moment.head->event.subject);
  take_values(moment,
              [](Recording::Direction direction) { return direction == Recording::Direction::real_input; });
  const Entry* const fault = recorded_failure(moment);
  const bool late = fault != nullptr && fault->event.fault() == Fault::overrun;
  operations_.start_call(behaviour, at_, late ? 1 : 0);
  unfinished_ = &moment;
}

/// Called late, because only now it is known that the recorded call had ended, too.
void RerunSubsystem::finish_call() {
  const RecordedMoment* const moment = std::exchange(unfinished_, nullptr);
  if (moment == nullptr) return;
  const Time fired_at = std::exchange(at_, Time(Duration(moment->head->event.time_ns)));
  operations_.finish_call(at_);
  const Entry* const fault = recorded_failure(*moment);
  const std::string_view behaviour = parts().instance->net->behaviours[moment->head->event.subject].name;
  if (fault != nullptr && !operations_.has_failed() && comes_from_outside(*fault))
    operations_.fail_as_recorded(fault->event.fault(), "as in the recorded run");
  if (operations_.has_failed() != (fault != nullptr))
    differ(fmt::format("the transition function of {}", behaviour),
           fault == nullptr ? "succeeded" : fault->text, fault == nullptr ? "failed" : "succeeded");
  take_values(*moment, [](Recording::Direction direction) {
    return direction == Recording::Direction::output || direction == Recording::Direction::real_output;
  });
  compare_outputs();
  ++report_.iterations;
  at_ = fired_at;
}

template <class Wanted>
void RerunSubsystem::take_values(const RecordedMoment& moment, Wanted wanted) {
  for (const Entry* entry : moment.rest) {
    if (entry->event.kind() != Event::Kind::value) continue;
    const ValueEvent value = value_of(*entry);
    if (wanted(recording_.buffers[value.buffer].direction)) held_[value.buffer - first_buffer_].take(value);
  }
}

void RerunSubsystem::compare_outputs() {
  for (std::size_t index = 0; index < outputs_.size(); ++index) {
    Output& output = outputs_[index];
    output.computed.clear();
    output.encoding->put(output.value, output.computed);
    const Held& held = held_[output.number - first_buffer_];
    const std::string computed = bytes_of(output.computed);
    if (computed == held.bytes) continue;
    ++report_.outputs[index].differing;
    if (!first_) name_difference(output, held, computed);
  }
}

/// Names the first field that differs.
void RerunSubsystem::name_difference(const Output& output, const Held& held, std::string_view computed) {
  const std::string name = recording_.buffers[output.number].path.substr(report_.path.size() + 1);
  if (held.hashed || !output.layout) return differ(name, "a large value", "another");
  std::vector<std::pair<std::string, std::string>> recorded;
  static_cast<void>(output.layout->visit(held.bytes, [&](const std::string& path, const auto& scalar) {
    recorded.emplace_back(path, scalar.shown());
  }));
  std::size_t index = 0;
  bool named = false;
  static_cast<void>(output.layout->visit(computed, [&](const std::string& path, const auto& scalar) {
    const std::size_t at = index++;
    if (named || at >= recorded.size() || recorded[at].second == scalar.shown()) return;
    named = true;
    differ(path.empty() ? name : name + (path.starts_with('[') ? "" : ".") + path, recorded[at].second,
           scalar.shown());
  }));
  if (!named) differ(name, output.layout->shown(held.bytes), output.layout->shown(computed));
}

void RerunSubsystem::fire(const RecordedMoment& moment) {
  finish_call();
  const Plan::TransitionEntry& transition =
      plan_->transitions[moment.head->event.subject - first_transition_];
  if (transition.latch.valid()) compare_decision(transition);
  if (transition.guard.kind == Guard::Kind::skip)
    operations_.note_answer(plan_->places[transition.latch.value].subject);
  if (transition.tells_of_timeout) {
    if (transition.guard.kind == Guard::Kind::elapsed)
      operations_.note_timeout(transition.port.value);
    else
      operations_.note_answer(transition.port.value);
  }
  for (const std::uint32_t place : plan_->outputs(transition)) start_operation(place, moment);
}

void RerunSubsystem::start_operation(std::uint32_t place, const RecordedMoment& moment) {
  const Plan::PlaceEntry& entry = plan_->places[place];
  switch (entry.does) {
    case Does::Kind::nothing:
    case Does::Kind::call:  // recorded separately
      break;
    case Does::Kind::count:
      operations_.count();
      break;
    case Does::Kind::begin:
      operations_.begin_iteration(entry.subject);
      break;
    case Does::Kind::write:
      operations_.write(entry.subject, entry.slot, at_);
      break;
    case Does::Kind::read:
      read(entry.subject, entry.slot, moment);
      if (entry.tells) decided_[place] = operations_.told(entry.subject);
      break;
    case Does::Kind::decide:
      decided_[place] = static_cast<int>(operations_.decide(entry.subject, at_));
      break;
    case Does::Kind::route:
      decided_[place] = operations_.route(entry.subject, at_);
      break;
    case Does::Kind::ask:
      decided_[place] = static_cast<int>(operations_.sends(entry.slot, entry.subject, at_));
      break;
    case Does::Kind::know:
      operations_.learn(entry.subject, entry.slot, at_);
      break;
  }
}

/// Puts the recorded value into the channel. The sequence number of newer values grows. Older values
/// alternate between the numbers 1 and 2, because a value with the same number as the last one is not read.
void RerunSubsystem::read(std::uint16_t port, std::uint16_t slot, const RecordedMoment& moment) {
  const PortLink& link = parts().ports[port];
  Time now = at_;
  for (const Entry* entry : moment.rest) {
    if (entry->event.kind() != Event::Kind::value) continue;
    const ValueEvent value = value_of(*entry);
    if (value.buffer != first_buffer_ + link.buffer) continue;
    Held& held = held_[link.buffer];
    held.take(value);
    SharedChannel::Memory& memory = link.channel->memory(slot);
    static_cast<void>(
        parts().bindings.inputs[link.buffer].encoding->take(memory.bytes.data(), as_bytes(held.bytes)));
    memory.stamp = Time(Duration(value.stamp_ns));
    memory.valid = value.has(ValueFlags::valid);
    Reads& reads = reads_[link.buffer];
    memory.sequence = value.has(ValueFlags::fresh) ? ++reads.newest : reads.older = 3 - reads.older;
    reads.last = memory.sequence;
    now = Time(Duration(entry->event.time_ns));
    return operations_.read(port, slot, now);
  }
  link.channel->memory(slot).sequence = reads_[link.buffer].last;  // no new value
  operations_.read(port, slot, now);
}

void RerunSubsystem::compare_decision(const Plan::TransitionEntry& transition) {
  const auto found = decided_.find(transition.latch.value);
  if (found == decided_.end()) return;
  const int computed = found->second;
  decided_.erase(found);
  if (computed == transition.decided) return;
  ++report_.decisions;
  if (plan_->places[transition.latch.value].does == Does::Kind::decide)
    operations_.accept_outcome(static_cast<Outcome>(transition.decided));
  const SubsystemNet& net = *parts().instance->net;
  std::string other = "none that the net has";
  for (const std::uint32_t index : plan_->leaving_of(transition.latch.value))
    if (plan_->transitions[index].latch == transition.latch && plan_->transitions[index].decided == computed)
      other = net.transitions[index].name;
  differ("the transition taken", std::string(net.transitions[transition.index].name), other);
}

void RerunSubsystem::differ(std::string what, std::string recorded, std::string computed) {
  if (first_) return;
  first_ = here();
  first_->what = std::move(what);
  first_->recorded = std::move(recorded);
  first_->computed = std::move(computed);
}

}  // namespace tessera
