#include "explore/pt_net.hpp"

#include <algorithm>

#include "tessera/firing.hpp"

namespace tessera::explore {
namespace {

using Rows = std::vector<std::vector<Touch>>;

/// A place that is both consumed from and produced into is one touch with both weights.
std::vector<Touch> touches_of(const net::Net& net, TransitionId transition) {
  std::vector<Touch> row;
  for (const net::Arc& arc : net.preset(transition)) row.push_back({arc.place.value, arc.weight, 0});
  for (const net::Arc& arc : net.postset(transition)) row.push_back({arc.place.value, 0, arc.weight});
  std::ranges::sort(row, {}, &Touch::node);
  std::size_t kept = 0;
  for (const Touch& touch : row) {
    if (kept > 0 && row[kept - 1].node == touch.node) {
      row[kept - 1].consumes += touch.consumes;
      row[kept - 1].produces += touch.produces;
    } else {
      row[kept++] = touch;
    }
  }
  row.resize(kept);
  return row;
}

}  // namespace

PtNet::PtNet(const net::Net& net) {
  for (const net::Place& place : net.places()) initial_.push_back(place.tokens);
  Rows transitions, places(net.places().size());
  for (std::uint32_t transition = 0; transition < net.transitions().size(); ++transition) {
    transitions.push_back(touches_of(net, TransitionId{transition}));
    for (const Touch& touch : transitions.back())
      places[touch.node].push_back({transition, touch.consumes, touch.produces});
  }
  std::size_t arcs = 0;
  for (const auto& row : transitions) arcs += 2 * row.size();
  touches_.reserve(arcs);
  const auto pack = [&](const Rows& rows, std::vector<std::span<const Touch>>& spans) {
    for (const auto& row : rows) {
      spans.emplace_back(touches_.data() + touches_.size(), row.size());
      touches_.insert(touches_.end(), row.begin(), row.end());
    }
  };
  pack(transitions, of_transition_);
  pack(places, of_place_);
}

bool PtNet::enabled(std::uint32_t transition, std::span<const Tokens> marking) const {
  return std::ranges::all_of(of_transition(transition), [&](const Touch& touch) {
    return firing::suffices(marking[touch.node], touch.consumes);
  });
}

void PtNet::fire(std::uint32_t transition, std::span<Tokens> marking) const {
  for (const Touch& touch : of_transition(transition))
    marking[touch.node] = firing::after(marking[touch.node], touch.consumes, touch.produces);
}

}  // namespace tessera::explore
