#include "subsystem/written_outputs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace tessera {
namespace {

void give_value(const Bindings::Outgoing& output, const void* value) {
  if (output.type == nullptr)
    std::memcpy(output.value, value, output.size);
  else
    output.type->assign(output.value, value);
}

}  // namespace

WrittenOutputs::WrittenOutputs(SubsystemParts& parts)
    : parts_(parts),
      states_(parts.bindings.outputs.size() + parts.bindings.real_outputs.size(), State::no),
      explained_(parts.bindings.outputs.size()) {
  for (const Bindings::RealOutgoing& output : parts_.bindings.real_outputs)
    give_value(output, output.safe.get());
}

/// Calls `visit(output, safe, state)` for outputs that are not known to be written. safe: nullptr: it is no
/// real output.
template <class Visit>
void WrittenOutputs::for_unwritten(Visit visit) {
  const Bindings& bindings = parts_.bindings;
  std::size_t number = 0;
  for (const Bindings::Outgoing& output : bindings.outputs)
    if (State& state = states_[number++]; state == State::no) visit(output, nullptr, state);
  for (const Bindings::RealOutgoing& output : bindings.real_outputs)
    if (State& state = states_[number++]; state == State::no) visit(output, output.safe.get(), state);
}

void WrittenOutputs::keep() {
  if (complete_) return;
  for (State& state : states_)
    if (state == State::in_this_iteration) state = State::yes;
  complete_ = std::ranges::all_of(states_, [](State state) { return state == State::yes; });
}

void WrittenOutputs::before_call() {
  if (complete_) return;
  // A zero with a minus may be what the function writes: without marks, in every second call, that is another
  // value. After a call without any input everything begins anew.
  marked_ = no_input_ || !marked_;
  for_unwritten([&](const Bindings::Outgoing& output, const void* safe, State&) {
    output.departure->tessera_assigned = false;
    if (safe != nullptr) output.trace->reset(output.value);
    if (marked_ && output.trace->mark != nullptr) output.trace->mark(output.value);
  });
}

void WrittenOutputs::after_call() {
  if (complete_) return;
  const auto& inputs = parts_.bindings.real_inputs;
  const auto has_value = [](const Bindings::Incoming& input) {
    return input.arrival->age != Duration::max();
  };
  no_input_ = !parts_.scripted && !inputs.empty() && std::ranges::none_of(inputs, has_value);
  all_inputs_ = !inputs.empty() && std::ranges::all_of(inputs, has_value);
  for_unwritten([&](const Bindings::Outgoing& output, const void* safe, State& state) {
    if (is_written(output))
      state = State::in_this_iteration;
    else if (safe != nullptr)
      give_value(output, safe);
  });
}

bool WrittenOutputs::is_written(const Bindings::Outgoing& output) const {
  const WriteTrace& trace = *output.trace;
  const bool unmarked = marked_ && trace.unmark != nullptr && trace.unmark(output.value);
  if (!trace.initial(output.value)) return true;
  if (no_input_) return false;
  return unmarked || output.departure->tessera_assigned || (all_inputs_ && trace.mark == nullptr);
}

void WrittenOutputs::undo() {
  for (State& state : states_)
    if (state == State::in_this_iteration) state = State::no;
}

bool WrittenOutputs::should_explain(std::uint32_t output) {
  if (no_input_ || !parts_.bindings.outputs[output].trace->hides || explained_[output]) return false;
  explained_[output] = true;
  return true;
}

}  // namespace tessera
