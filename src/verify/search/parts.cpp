#include "verify/search/parts.hpp"

namespace tessera::verify {

Part::Part(const net::Net& net, std::span<const reduce::Component* const> components)
    : place_of_(net.places().size()) {
  for (const reduce::Component* component : components)
    for (const net::PlaceId place : component->places) place_of_[place.value] = part_.add(net[place]);
  const auto moved = [&](std::span<const net::Arc> arcs) {
    std::vector<net::Arc> result;
    for (const net::Arc& arc : arcs) result.push_back({place_of_[arc.place.value], arc.weight});
    return result;
  };
  for (const reduce::Component* component : components)
    for (const net::TransitionId id : component->transitions) {
      part_.add(net[id], moved(net.preset(id)), moved(net.postset(id)));
      original_.push_back(id);
    }
}

explore::Formula Part::inside(explore::Formula formula) const {
  if (formula.kind == explore::Formula::Kind::at_least) formula.node = place_of_[formula.node].value;
  for (explore::Formula& part : formula.parts) part = inside(std::move(part));
  return formula;
}

std::vector<net::TransitionId> Part::outside(const std::vector<net::TransitionId>& trace) const {
  std::vector<net::TransitionId> result;
  for (const net::TransitionId id : trace) result.push_back(original_[id.value]);
  return result;
}

void places_of(const explore::Formula& formula, std::vector<net::PlaceId>& to) {
  if (formula.kind == explore::Formula::Kind::at_least) to.push_back({formula.node});
  for (const explore::Formula& part : formula.parts) places_of(part, to);
}

}  // namespace tessera::verify
