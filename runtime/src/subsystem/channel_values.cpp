#include "subsystem/channel_values.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <utility>

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

ChannelValues::ChannelValues(const SubsystemParts& parts, const RunControl& control)
    : parts_(parts), control_(control), inputs_(parts.bindings.inputs.size()) {
  for (std::size_t index = 0; index < inputs_.size(); ++index)
    inputs_[index].arrival = parts_.bindings.inputs[index].arrival;
  for (const PortLink& port : parts_.ports) {
    if (port.end != nullptr) remote_.push_back(&port);
    if (port.side != Side::receive) continue;
    inputs_[port.buffer].used = true;
    inputs_[port.buffer].source = port.peer;
  }
  for (const Fact& fact : parts_.instance->net->facts) {
    const auto input = std::ranges::find(parts_.bindings.inputs, fact.name, &Bindings::Incoming::name);
    const bool received = fact.kind == Fact::Kind::received && input != parts_.bindings.inputs.end();
    outcomes_.push_back({received ? input->arrival : nullptr,
                         static_cast<std::uint32_t>(input - parts_.bindings.inputs.begin())});
  }
  if (!parts_.effectors.empty()) find_received_inputs();
}

/// A transition into a place that reads says which behaviour receives.
void ChannelValues::find_received_inputs() {
  const SubsystemNet& net = *parts_.instance->net;
  received_.resize(net.behaviours.size());
  for (const Transition& transition : net.transitions) {
    if (transition.role.behaviour >= received_.size()) continue;
    std::vector<std::uint32_t>& inputs = received_[transition.role.behaviour];
    for (const ArcEnd end : transition.outputs) {
      if (end.is_shared() || net.places[end.place()].does.kind != Does::Kind::read) continue;
      const std::uint32_t input = parts_.ports[net.places[end.place()].does.subject].buffer;
      if (std::ranges::find(inputs, input) == inputs.end()) inputs.push_back(input);
    }
  }
}

void ChannelValues::write(std::uint32_t port, std::uint16_t slot, Time now, bool valid) {
  const PortLink& link = parts_.ports[port];
  const Bindings::Outgoing& output = parts_.bindings.outputs[link.buffer];
  output.departure->stamp = now;
  if (link.end != nullptr) return link.end->write(output.value, now, valid);
  SharedChannel::Memory& memory = link.channel->memory(slot);
  assign(memory.bytes.data(), output.value, output.size, output.type);
  if (parts_.readings != nullptr) parts_.readings->give(port, memory.readings);
  memory.stamp = now;
  memory.valid = valid;
  memory.sequence = link.channel->next_sequence();
}

/// A slot may hold a value that was read before, or an older one: only a newer one is fresh.
void ChannelValues::read(std::uint32_t port, std::uint16_t slot, Time now) {
  const PortLink& link = parts_.ports[port];
  const Bindings::Incoming& input = parts_.bindings.inputs[link.buffer];
  Input& state = inputs_[link.buffer];
  input.arrival->timed_out = false;
  state.taken_fresh = false;
  const SharedChannel::Memory& memory = link.channel->memory(slot);
  if (parts_.readings != nullptr) parts_.readings->take(port, memory.readings);
  if (memory.sequence == 0 || memory.sequence == state.sequence) return;
  const bool newer = memory.sequence > state.newest;
  state.newest = std::max(state.newest, memory.sequence);
  state.sequence = memory.sequence;
  if (memory.valid && memory.stamp >= control_.valid_from()) {
    state.last_valid = memory.stamp;
    state.known = true;
  }
  input.arrival->valid = memory.valid;
  input.arrival->failed = !memory.valid;
  if (memory.valid) {
    assign(input.value, memory.bytes.data(), input.size, input.type);
    state.given = true;
    input.arrival->fresh = input.arrival->fresh || newer;
    state.taken_fresh = newer;
    input.arrival->stamp = memory.stamp;
    input.arrival->age = age(memory.stamp, now);
  }
  if (parts_.values != nullptr) parts_.values->input(link.buffer, now, memory.stamp, newer);
}

void ChannelValues::note_timeout(std::uint32_t port) {
  const PortLink& link = parts_.ports[port];
  if (link.side == Side::receive)
    parts_.bindings.inputs[link.buffer].arrival->timed_out = true;
  else
    parts_.bindings.outputs[link.buffer].departure->timed_out = true;
}

void ChannelValues::note_answer(std::uint32_t port) {
  const PortLink& link = parts_.ports[port];
  if (link.side == Side::send) parts_.bindings.outputs[link.buffer].departure->timed_out = false;
}

void ChannelValues::learn(std::uint16_t fact, std::uint16_t value) {
  Outcome& outcome = outcomes_[fact];
  if (outcome.arrival != nullptr) outcome.fresh = value == 0 && inputs_[outcome.input].taken_fresh;
}

ChannelValues::OutcomesShown::OutcomesShown(ChannelValues& values) : values_(values) {
  for (Outcome& outcome : values_.outcomes_)
    if (outcome.arrival != nullptr) std::swap(outcome.arrival->fresh, outcome.fresh);
}

ChannelValues::OutcomesShown::~OutcomesShown() {
  for (Outcome& outcome : values_.outcomes_)
    if (outcome.arrival != nullptr) std::swap(outcome.arrival->fresh, outcome.fresh);
}

void ChannelValues::await_inputs(std::uint16_t behaviour) {
  if (received_.empty()) return;
  for (const std::uint32_t input : received_[behaviour]) inputs_[input].awaited = true;
}

void ChannelValues::refresh_ages(Time now) {
  for (const Input& input : inputs_)
    if (input.given) input.arrival->age = age(input.arrival->stamp, now);
  for (const PortLink* const port : remote_) {
    const bool disconnected = port->end->disconnected();
    if (port->side == Side::receive)
      parts_.bindings.inputs[port->buffer].arrival->disconnected = disconnected;
    else
      parts_.bindings.outputs[port->buffer].departure->disconnected = disconnected;
  }
}

void ChannelValues::mark_seen() {
  for (const Input& input : inputs_) input.arrival->fresh = false;
}

SafeReason ChannelValues::why_hold(Time now) const {
  using Why = SafeReason::Kind;
  const Duration stale = parts_.instance->stale;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    const Input& input = inputs_[index];
    if (!input.used) continue;
    const std::string_view name = parts_.bindings.inputs[index].name;
    if (input.source.valid()) {
      if (control_.has_ended(input.source.value)) return {Why::source_ended, name};
      if (control_.is_stalled(input.source.value)) return {Why::source_stalls, name};
    }
    if (stale > Duration::zero() && now - input.last_valid > stale) return {Why::stale, name};
    if (input.awaited && (!input.known || input.last_valid < control_.valid_from()))
      return {Why::starting, name};
  }
  return {};
}

Time ChannelValues::stale_from() const {
  Time earliest = Time::max();
  for (const Input& input : inputs_)
    if (input.used) earliest = std::min(earliest, input.last_valid + parts_.instance->stale + Duration(1));
  return earliest;
}

}  // namespace tessera
