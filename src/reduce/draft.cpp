#include "reduce/draft.hpp"

#include <algorithm>

namespace tessera::reduce {
namespace {

Arcs sorted(std::span<const Arc> arcs) {
  Arcs all(arcs.begin(), arcs.end());
  std::ranges::sort(all);
  return all;
}

}  // namespace

Draft::Draft(const net::Net& net, const Preserve& what)
    : place_is_open_(net.places().size(), false), transition_is_open_(net.transitions().size(), false) {
  places_.reserve(net.places().size());
  for (const net::Place& place : net.places()) places_.push_back({.tokens = place.tokens});
  for (const net::PlaceId place : what.observed) places_[place.value].observed = true;
  for (std::uint32_t place = 0; place < places_.size(); ++place) put(place, open_places_, place_is_open_);
  transitions_.reserve(net.transitions().size());
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    add({.inputs = sorted(net.preset(id)), .outputs = sorted(net.postset(id)), .sequence = index});
  }
  for (std::uint32_t set = 0; set < what.sets.size(); ++set)
    for (const net::TransitionId id : what.sets[set]) {
      auto& sets = transitions_[id.value].sets;
      if (sets.empty() || sets.back() != set) sets.push_back(set);
    }
}

bool Draft::touches_observed(const Transition& transition) const {
  const auto observed = [&](const Arc& arc) { return places_[arc.place.value].observed; };
  return std::ranges::any_of(transition.inputs, observed) ||
         std::ranges::any_of(transition.outputs, observed);
}

void Draft::add(Transition transition) {
  const auto index = static_cast<std::uint32_t>(transitions_.size());
  transitions_.push_back(std::move(transition));
  if (transition_is_open_.size() <= index) transition_is_open_.resize(index + 1, false);
  for (const Arc& arc : transitions_[index].inputs) places_[arc.place.value].consumers.push_back(index);
  for (const Arc& arc : transitions_[index].outputs) places_[arc.place.value].producers.push_back(index);
  put(index, open_transitions_, transition_is_open_);
  touch(transitions_[index]);
}

void Draft::touch(const Transition& transition) {
  if (transition.alive && !is_small(transition)) return;
  for (const auto* arcs : {&transition.inputs, &transition.outputs})
    for (const Arc& arc : *arcs) put(arc.place.value, open_places_, place_is_open_);
}

void Draft::remove_place(std::uint32_t index) {
  Place& place = places_[index];
  for (const std::uint32_t transition : place.producers) {
    std::erase_if(transitions_[transition].outputs, [&](const Arc& arc) { return arc.place.value == index; });
    put(transition, open_transitions_, transition_is_open_);
    touch(transitions_[transition]);
  }
  for (const std::uint32_t transition : place.consumers) {
    std::erase_if(transitions_[transition].inputs, [&](const Arc& arc) { return arc.place.value == index; });
    put(transition, open_transitions_, transition_is_open_);
    touch(transitions_[transition]);
  }
  place.producers.clear();
  place.consumers.clear();
  place.alive = false;
}

void Draft::remove_transition(std::uint32_t index) {
  Transition& transition = transitions_[index];
  for (const Arc& arc : transition.inputs) std::erase(places_[arc.place.value].consumers, index);
  for (const Arc& arc : transition.outputs) std::erase(places_[arc.place.value].producers, index);
  transition.alive = false;
  touch(transition);
  transition.inputs.clear();
  transition.outputs.clear();
}

void Draft::add_to_sets(std::uint32_t transition, const std::vector<std::uint32_t>& sets) {
  transitions_[transition].sets = united(transitions_[transition].sets, sets);
}

void Draft::fire(std::uint32_t index) {
  for (const Arc& arc : transitions_[index].inputs) places_[arc.place.value].tokens -= arc.weight;
  for (const Arc& arc : transitions_[index].outputs) places_[arc.place.value].tokens += arc.weight;
}

std::optional<std::uint32_t> Draft::take(std::vector<std::uint32_t>& open, std::vector<bool>& is_open) {
  if (open.empty()) return std::nullopt;
  const std::uint32_t item = open.back();
  open.pop_back();
  is_open[item] = false;
  return item;
}

void Draft::put(std::uint32_t item, std::vector<std::uint32_t>& open, std::vector<bool>& is_open) {
  if (is_open[item]) return;
  is_open[item] = true;
  open.push_back(item);
}

std::uint32_t weight_at(const Arcs& arcs, std::uint32_t place) {
  const auto arc = std::ranges::lower_bound(arcs, net::PlaceId{place}, {}, &Arc::place);
  return arc != arcs.end() && arc->place.value == place ? arc->weight : 0;
}

Arcs sum(const Arcs& a, const Arcs& b) {
  Arcs both;
  both.reserve(a.size() + b.size());
  std::ranges::merge(a, b, std::back_inserter(both));
  std::size_t kept = 0;
  for (std::size_t index = 0; index < both.size(); ++index) {
    if (kept > 0 && both[kept - 1].place == both[index].place)
      both[kept - 1].weight += both[index].weight;
    else
      both[kept++] = both[index];
  }
  both.resize(kept);
  return both;
}

Arcs without(const Arcs& arcs, std::uint32_t place) {
  Arcs rest;
  rest.reserve(arcs.size());
  std::ranges::copy_if(arcs, std::back_inserter(rest),
                       [&](const Arc& arc) { return arc.place.value != place; });
  return rest;
}

std::vector<std::uint32_t> united(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::vector<std::uint32_t> both;
  std::ranges::set_union(a, b, std::back_inserter(both));
  return both;
}

}  // namespace tessera::reduce
