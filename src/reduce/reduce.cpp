#include "reduce/reduce.hpp"

#include <algorithm>

#include "net/token_game.hpp"
#include "reduce/draft.hpp"

namespace tessera::reduce {
namespace {

/// Removes impossible transitions. This is not a rule: every rule assumes that all transitions are possible.
void drop_impossible(const net::Net& net, Work& work) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    if (net.transitions()[index].condition.truth != net::Condition::Truth::never) continue;
    work.draft.remove_transition(index);
    ++work.count.impossible_transitions;
  }
}

/// Transitions come first: they are cheap, and the remaining ones decide about the places.
void exhaust(Work& work) {
  for (;;) {
    if (const auto transition = work.draft.next_transition()) {
      if (work.draft.transitions()[*transition].alive) reduce_transition(work, *transition);
      continue;
    }
    const auto place = work.draft.next_place();
    if (!place) return;
    if (work.draft.places()[*place].alive && !reduce_place(work, *place)) agglomerate(work, *place);
  }
}

/// The name of a transition that represents a sequence consists of the first and the last name.
std::string joined_name(const std::string& first, const std::string& last) {
  return first == last ? first : first + " .. " + last;
}

}  // namespace

Reduced reduce(const net::Net& net, const Preserve& what, const Rules& on) {
  Reduced result;
  Draft draft(net, what);
  std::vector<Sequence> sequences(net.transitions().size());
  Work work{draft, what, on, result.statistics, sequences, result.start_, result.delayed_};
  drop_impossible(net, work);
  exhaust(work);

  result.original_ = &net;
  result.place_of_.resize(net.places().size());
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    if (!draft.places()[index].alive) continue;
    net::Place place = net.places()[index];
    place.tokens = draft.places()[index].tokens;
    result.place_of_[index] = result.net.add(std::move(place));
  }
  // Sequences are made of earlier ones, so their ends can be found in order.
  std::vector<std::uint32_t> first(sequences.size()), last(sequences.size());
  for (std::uint32_t index = 0; index < sequences.size(); ++index) {
    const auto [before, after] = sequences[index];
    first[index] = after ? first[before] : index;
    last[index] = after ? last[*after] : index;
  }
  result.sequences_ = std::move(sequences);
  result.sets.resize(what.sets.size());
  for (const Draft::Transition& transition : draft.transitions()) {
    if (!transition.alive) continue;
    Arcs inputs = transition.inputs, outputs = transition.outputs;
    for (Arcs* arcs : {&inputs, &outputs})
      for (Arc& arc : *arcs) arc.place = result.place_of_[arc.place.value];
    net::Transition made = net.transitions()[first[transition.sequence]];
    made.name = joined_name(made.name, net.transitions()[last[transition.sequence]].name);
    const net::TransitionId id = result.net.add(std::move(made), inputs, outputs);
    result.fires_.push_back(transition.sequence);
    for (const std::uint32_t set : transition.sets) result.sets[set].push_back(id);
  }
  result.statistics.places_before = net.places().size();
  result.statistics.transitions_before = net.transitions().size();
  result.statistics.places_after = result.net.places().size();
  result.statistics.transitions_after = result.net.transitions().size();
  return result;
}

std::optional<net::PlaceId> Reduced::find(net::PlaceId original) const {
  const net::PlaceId place = place_of_[original.value];
  return place.valid() ? std::optional(place) : std::nullopt;
}

void Reduced::append(std::uint32_t sequence, std::vector<net::TransitionId>& to) const {
  std::vector<std::uint32_t> open{sequence};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    const Sequence& found = sequences_[at];
    if (!found.second) {
      to.push_back({at});
      continue;
    }
    open.push_back(*found.second);
    open.push_back(found.first);
  }
}

/// Fires the delayed transitions, so that a dead marking of the reduced net becomes a dead marking of the
/// original one. Undoes the rules from the last to the first.
void Reduced::settle(std::vector<net::TransitionId>& trace) const {
  net::Marking marking = net::marking_after(*original_, trace);
  for (auto sequence = delayed_.rbegin(); sequence != delayed_.rend(); ++sequence) {
    std::vector<net::TransitionId> parts;
    append(*sequence, parts);
    while (net::fire_all(*original_, parts, marking)) trace.insert(trace.end(), parts.begin(), parts.end());
  }
}

std::vector<net::TransitionId> Reduced::lift(std::span<const net::TransitionId> trace) const {
  std::vector<net::TransitionId> lifted;
  for (const std::uint32_t sequence : start_) append(sequence, lifted);
  for (const net::TransitionId id : trace) append(fires_[id.value], lifted);
  settle(lifted);
  return lifted;
}

}  // namespace tessera::reduce
