#include <algorithm>

#include "reduce/draft.hpp"

namespace tessera::reduce {
namespace {

/// No firing raises the place, and it holds less than the transition needs.
bool never_enabled(const Draft& draft, const Draft::Transition& transition) {
  return std::ranges::any_of(transition.inputs, [&](const Arc& arc) {
    const Draft::Place& place = draft.places()[arc.place.value];
    if (place.tokens >= arc.weight || place.producers.size() > most_arcs) return false;
    return std::ranges::all_of(place.producers, [&](std::uint32_t producer) {
      const Draft::Transition& by = draft.transitions()[producer];
      return weight_at(by.outputs, arc.place.value) <= weight_at(by.inputs, arc.place.value);
    });
  });
}

/// The transitions among which one that needs no more could be: those that share the input place with the
/// fewest consumers. Those without any input are not found.
const std::vector<std::uint32_t>* candidates(const Draft& draft, const Draft::Transition& transition) {
  const std::vector<std::uint32_t>* fewest = nullptr;
  for (const Arc& arc : transition.inputs) {
    const auto& consumers = draft.places()[arc.place.value].consumers;
    if (fewest == nullptr || consumers.size() < fewest->size()) fewest = &consumers;
  }
  return fewest != nullptr && fewest->size() <= most_arcs ? fewest : nullptr;
}

bool needs_no_more(const Arcs& a, const Arcs& b) {
  return std::ranges::all_of(a, [&](const Arc& arc) { return arc.weight <= weight_at(b, arc.place.value); });
}

bool drop_parallel(Work& work, std::uint32_t index) {
  const Draft::Transition& transition = work.draft.transitions()[index];
  const auto* others = candidates(work.draft, transition);
  if (others == nullptr) return false;
  for (const std::uint32_t other : *others) {
    const Draft::Transition& kept = work.draft.transitions()[other];
    if (other == index || kept.inputs != transition.inputs || kept.outputs != transition.outputs) continue;
    work.draft.add_to_sets(other, transition.sets);
    work.draft.remove_transition(index);
    ++work.count.parallel_transitions;
    return true;
  }
  return false;
}

bool drop_identity(Work& work, std::uint32_t index) {
  const Draft::Transition& transition = work.draft.transitions()[index];
  if (!transition.sets.empty() || transition.inputs != transition.outputs) return false;
  const auto* others = candidates(work.draft, transition);
  if (others == nullptr) return false;
  for (const std::uint32_t other : *others) {
    if (other == index || !needs_no_more(work.draft.transitions()[other].inputs, transition.inputs)) continue;
    work.draft.remove_transition(index);
    ++work.count.identity_transitions;
    return true;
  }
  return false;
}

}  // namespace

bool reduce_transition(Work& work, std::uint32_t index) {
  if (work.on.dead_transitions && never_enabled(work.draft, work.draft.transitions()[index])) {
    work.draft.remove_transition(index);
    ++work.count.dead_transitions;
    return true;
  }
  if (work.on.parallel_transitions && drop_parallel(work, index)) return true;
  return work.on.identity_transitions && drop_identity(work, index);
}

}  // namespace tessera::reduce
