#include "layers/closed_pair.hpp"

#include <string>
#include <vector>

namespace tessera::layers {
namespace {

using net::Arc;
using net::Operation;
using net::PlaceId;
using spec::ModelSide;

/// Adds one side behind the shared places, which come first.
net::TransitionId add_side(net::Net& net, const ModelSide& side, const std::string& name,
                           Operation::Kind kind) {
  std::vector<PlaceId> places;
  for (const ModelSide::Place& place : side.places) {
    net::Place added{.name = name + "." + place.name,
                     .tokens = places.size() == ModelSide::in ? 1U : 0U,
                     .layer = net::Layer::communication,
                     .span = place.span};
    if (place.slot) added.operation = {.kind = kind, .channel = {0}, .slot = *place.slot};
    places.push_back(net.add(std::move(added)));
  }
  const auto arcs = [&](std::uint32_t own, const std::vector<std::uint32_t>& shared) {
    std::vector<Arc> all{{places[own], 1}};
    for (const std::uint32_t place : shared) all.push_back({PlaceId{place}, 1});
    return all;
  };
  for (const ModelSide::Transition& transition : side.transitions) {
    net::Transition added{
        .name = name + "." + transition.name, .layer = net::Layer::communication, .span = transition.span};
    if (transition.elapsed)
      added.condition = {
          .kind = net::Condition::Kind::elapsed, .truth = net::Condition::Truth::free, .channel = {0}};
    net.add(std::move(added), arcs(transition.from, transition.takes), arcs(transition.to, transition.gives));
  }
  return net.add({.name = name + " again", .layer = net::Layer::communication}, arcs(ModelSide::out, {}),
                 arcs(ModelSide::in, {}));
}

}  // namespace

ClosedPair closed_pair(const spec::CommunicationModel& model) {
  ClosedPair pair;
  for (const spec::SharedPlace& place : model.shared)
    pair.net.add({.name = place.name,
                  .tokens = place.tokens,
                  .layer = net::Layer::communication,
                  .channel = {0},
                  .span = place.span});
  pair.sends_again = add_side(pair.net, model.send, "send", Operation::Kind::write);
  pair.receives_again = add_side(pair.net, model.receive, "receive", Operation::Kind::read);
  return pair;
}

}  // namespace tessera::layers
