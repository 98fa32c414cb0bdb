#include "oracle/nets/of_net.hpp"

#include <span>

namespace oracle {
namespace {

namespace net = tessera::net;

std::vector<Arc> plain_arcs(std::span<const net::Arc> arcs) {
  std::vector<Arc> plain;
  for (const net::Arc& arc : arcs) plain.push_back({arc.place.value, arc.weight});
  return plain;
}

std::vector<net::Arc> tessera_arcs(const std::vector<Arc>& arcs) {
  std::vector<net::Arc> result;
  for (const Arc& arc : arcs) result.push_back({net::PlaceId{arc.place}, arc.weight});
  return result;
}

PetriNet::Transition plain_transition(const net::Net& from, net::TransitionId id, Conditions conditions) {
  const bool never = from[id].condition.truth == net::Condition::Truth::never;
  return {plain_arcs(from.preset(id)), plain_arcs(from.postset(id)),
          never && conditions == Conditions::as_known};
}

}  // namespace

PetriNet petri_net(const net::Net& net, Conditions conditions) {
  PetriNet plain{initial_marking(net)};
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    plain.transitions.push_back(plain_transition(net, {index}, conditions));
  return plain;
}

net::Net tessera_net(const PetriNet& plain) {
  net::Net made;
  for (const std::uint32_t tokens : plain.initial)
    made.add({.name = "p" + std::to_string(made.places().size()), .tokens = tokens});
  for (const PetriNet::Transition& one : plain.transitions) {
    net::Transition transition{.name = "t" + std::to_string(made.transitions().size())};
    if (one.never) transition.condition.truth = net::Condition::Truth::never;
    made.add(std::move(transition), tessera_arcs(one.inputs), tessera_arcs(one.outputs));
  }
  return made;
}

Marking initial_marking(const net::Net& net) {
  Marking marking;
  for (const net::Place& place : net.places()) marking.push_back(place.tokens);
  return marking;
}

std::optional<Marking> fired(const net::Net& net, net::TransitionId transition, const Marking& marking) {
  return fired(plain_transition(net, transition, Conditions::as_known), marking);
}

std::optional<Marking> replayed(const net::Net& net, const std::vector<net::TransitionId>& run) {
  std::optional<Marking> marking = initial_marking(net);
  for (const net::TransitionId transition : run) {
    marking = fired(net, transition, *marking);
    if (!marking) return std::nullopt;
  }
  return marking;
}

}  // namespace oracle
