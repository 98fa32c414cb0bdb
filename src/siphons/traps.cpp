#include "siphons/traps.hpp"

#include <algorithm>
#include <utility>

namespace tessera::siphons {
namespace {

using explore::PtNet;
using explore::Touch;

bool puts_into(const PtNet& net, std::uint32_t transition, const PlaceSet& set) {
  return std::ranges::any_of(net.of_transition(transition),
                             [&](const Touch& touch) { return touch.produces > 0 && set[touch.node] != 0; });
}

/// Whether a transition takes from the place and puts nothing into the set.
bool leaks(const PtNet& net, std::uint32_t place, const PlaceSet& set) {
  return std::ranges::any_of(net.of_place(place), [&](const Touch& touch) {
    return touch.consumes > 0 && !puts_into(net, touch.node, set);
  });
}

std::vector<std::uint32_t> members(const PlaceSet& set) {
  std::vector<std::uint32_t> places;
  for (std::uint32_t place = 0; place < set.size(); ++place)
    if (set[place] != 0) places.push_back(place);
  return places;
}

/// Removes the place, and appends the places that must be checked after that.
void take_out(const PtNet& net, PlaceSet& set, std::uint32_t place, std::vector<std::uint32_t>& suspects) {
  set[place] = 0;
  for (const Touch& into : net.of_place(place)) {
    if (into.produces == 0) continue;
    for (const Touch& source : net.of_transition(into.node))
      if (source.consumes > 0 && set[source.node] != 0) suspects.push_back(source.node);
  }
}

}  // namespace

void shrink_to_trap(const PtNet& net, PlaceSet& set, std::vector<std::uint32_t> suspects) {
  while (!suspects.empty()) {
    const std::uint32_t place = suspects.back();
    suspects.pop_back();
    if (set[place] != 0 && leaks(net, place, set)) take_out(net, set, place, suspects);
  }
}

void shrink_to_trap(const PtNet& net, PlaceSet& set) { shrink_to_trap(net, set, members(set)); }

std::uint32_t marked_place(const PtNet& net, const PlaceSet& set) {
  for (std::uint32_t place = 0; place < set.size(); ++place)
    if (set[place] != 0 && net.initial()[place] > 0) return place;
  return net.places();
}

std::vector<std::uint32_t> small_marked_trap(const PtNet& net, PlaceSet within) {
  constexpr std::size_t most_attempts = 200;
  shrink_to_trap(net, within);
  std::vector<std::uint32_t> marked;  // initially, in the trap
  for (const std::uint32_t place : members(within))
    if (net.initial()[place] > 0) marked.push_back(place);
  const auto keeps_token = [&](const PlaceSet& set) {
    return std::ranges::any_of(marked, [&](std::uint32_t place) { return set[place] != 0; });
  };
  if (marked.empty()) return {};
  std::size_t attempts = 0;
  for (const std::uint32_t place : members(within)) {
    if (within[place] == 0 || ++attempts > most_attempts) continue;
    PlaceSet smaller = within;
    std::vector<std::uint32_t> suspects;
    take_out(net, smaller, place, suspects);
    shrink_to_trap(net, smaller, std::move(suspects));
    if (keeps_token(smaller)) within = std::move(smaller);
  }
  return members(within);
}

}  // namespace tessera::siphons
