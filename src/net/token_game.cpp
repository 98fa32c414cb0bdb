#include "net/token_game.hpp"

#include <algorithm>

namespace tessera::net {
namespace {

void take(std::span<const Arc> arcs, Marking& marking) {
  for (const Arc& arc : arcs) marking[arc.place.value] -= arc.weight;
}

void give(std::span<const Arc> arcs, Marking& marking) {
  for (const Arc& arc : arcs) marking[arc.place.value] += arc.weight;
}

}  // namespace

Marking initial_marking(const Net& net) {
  Marking marking;
  marking.reserve(net.places().size());
  for (const Place& place : net.places()) marking.push_back(place.tokens);
  return marking;
}

bool suffices(const Marking& marking, const Arc& input) { return marking[input.place.value] >= input.weight; }

bool enabled(const Net& net, TransitionId transition, const Marking& marking) {
  return std::ranges::all_of(net.preset(transition),
                             [&](const Arc& input) { return suffices(marking, input); });
}

void fire(const Net& net, TransitionId transition, Marking& marking) {
  take(net.preset(transition), marking);
  give(net.postset(transition), marking);
}

bool fire_all(const Net& net, std::span<const TransitionId> run, Marking& marking) {
  for (std::size_t fired = 0; fired < run.size(); ++fired) {
    if (enabled(net, run[fired], marking)) {
      fire(net, run[fired], marking);
      continue;
    }
    while (fired-- > 0) {
      take(net.postset(run[fired]), marking);
      give(net.preset(run[fired]), marking);
    }
    return false;
  }
  return true;
}

Marking marking_after(const Net& net, std::span<const TransitionId> run) {
  Marking marking = initial_marking(net);
  for (const TransitionId transition : run) fire(net, transition, marking);
  return marking;
}

}  // namespace tessera::net
