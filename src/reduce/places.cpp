#include <algorithm>

#include "reduce/draft.hpp"

namespace tessera::reduce {
namespace {

bool is_constant(const Draft& draft, std::uint32_t index) {
  const Draft::Place& place = draft.places()[index];
  return std::ranges::all_of(place.consumers, [&](std::uint32_t consumer) {
    const Draft::Transition& transition = draft.transitions()[consumer];
    const std::uint32_t taken = weight_at(transition.inputs, index);
    return taken <= place.tokens && weight_at(transition.outputs, index) >= taken;
  });
}

/// Whether `place` holds at least as many tokens as `other` after every firing, if it did before, and no
/// transition needs more tokens of it.
bool follows(const Draft& draft, std::uint32_t place, std::uint32_t other) {
  const Draft::Place &p = draft.places()[place], &q = draft.places()[other];
  if (p.tokens < q.tokens || q.consumers.size() + q.producers.size() > most_arcs) return false;
  const auto kept_by = [&](std::uint32_t index) {
    const Draft::Transition& transition = draft.transitions()[index];
    const std::int64_t p_in = weight_at(transition.inputs, place), q_in = weight_at(transition.inputs, other);
    const std::int64_t p_out = weight_at(transition.outputs, place),
                       q_out = weight_at(transition.outputs, other);
    return p_in <= q_in && p_out - p_in >= q_out - q_in;
  };
  for (const auto* transitions : {&p.consumers, &q.producers})
    if (!std::ranges::all_of(*transitions, kept_by)) return false;
  return true;
}

bool is_implicit(const Draft& draft, std::uint32_t index) {
  const Draft::Place& place = draft.places()[index];
  if (place.consumers.size() > most_arcs || place.consumers.empty()) return false;
  const Arcs& beside = draft.transitions()[place.consumers.front()].inputs;
  if (beside.size() > most_arcs) return false;
  return std::ranges::any_of(beside, [&](const Arc& arc) {
    return arc.place.value != index && follows(draft, index, arc.place.value);
  });
}

/// Handles a start-up place: fires the transition that empties it.
bool fire_start(Work& work, std::uint32_t index) {
  const Draft::Place& place = work.draft.places()[index];
  if (place.tokens == 0 || !place.producers.empty() || place.consumers.size() != 1) return false;
  const std::uint32_t consumer = place.consumers.front();
  const Draft::Transition& transition = work.draft.transitions()[consumer];
  if (transition.inputs.size() != 1 || transition.inputs.front().weight != 1) return false;
  if (work.draft.touches_observed(transition)) return false;
  while (work.draft.places()[index].tokens > 0) {
    work.draft.fire(consumer);
    work.start.push_back(transition.sequence);
  }
  work.draft.remove_transition(consumer);
  work.draft.remove_place(index);
  ++work.count.start;
  return true;
}

}  // namespace

bool reduce_place(Work& work, std::uint32_t index) {
  const Draft::Place& place = work.draft.places()[index];
  if (place.observed) return false;
  std::size_t* count = nullptr;
  if (work.on.sink_places && place.consumers.empty())
    count = &work.count.sink_places;
  else if (work.on.constant_places && is_constant(work.draft, index))
    count = &work.count.constant_places;
  else if (work.on.implicit_places && is_implicit(work.draft, index))
    count = &work.count.implicit_places;
  if (count == nullptr) return work.on.start && fire_start(work, index);
  work.draft.remove_place(index);
  ++*count;
  return true;
}

}  // namespace tessera::reduce
