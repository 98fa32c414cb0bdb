#include "executor_oracle.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace tessera::testing {
namespace {

std::vector<oracle::Arc> plain_arcs(const std::vector<ExecutableNet::Arc>& arcs) {
  std::vector<oracle::Arc> plain;
  for (const ExecutableNet::Arc& arc : arcs) plain.push_back({arc.place, arc.weight});
  return plain;
}

/// Half of the arcs of weight 2 become two arcs.
std::vector<ExecutableNet::Arc> executable_arcs(Random& random, const std::vector<oracle::Arc>& arcs) {
  std::vector<ExecutableNet::Arc> result;
  for (const oracle::Arc& arc : arcs) {
    const bool split = arc.weight == 2 && oracle::below(random, 2) == 0;
    result.push_back({arc.place, split ? 1 : arc.weight});
    if (split) result.push_back({arc.place, 1});
  }
  return result;
}

}  // namespace

oracle::PetriNet petri_net(const ExecutableNet& net) {
  oracle::PetriNet plain;
  for (const ExecutableNet::Place& place : net.places) plain.initial.push_back(place.tokens);
  for (const ExecutableNet::Transition& transition : net.transitions)
    plain.transitions.push_back({plain_arcs(transition.inputs), plain_arcs(transition.outputs)});
  return plain;
}

std::vector<std::uint32_t> NaiveRun::enabled() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t transition = 0; transition < net_.transitions.size(); ++transition)
    if (oracle::fired(net_.transitions[transition], marking_)) result.push_back(transition);
  return result;
}

bool NaiveRun::fire(std::uint32_t transition) {
  auto next = oracle::fired(net_.transitions[transition], marking_);
  if (next) marking_ = std::move(*next);
  return next.has_value();
}

ExecutableNet random_net(Random& random) {
  const oracle::PetriNet plain =
      oracle::below(random, 2) == 0 ? oracle::random_machines(random) : oracle::random_weighted(random);
  ExecutableNet net;
  for (const std::uint32_t tokens : plain.initial) net.places.push_back({.tokens = tokens});
  for (const oracle::PetriNet::Transition& transition : plain.transitions) {
    std::vector<ExecutableNet::Arc> inputs = executable_arcs(random, transition.inputs);
    net.transitions.push_back(
        {.inputs = std::move(inputs), .outputs = executable_arcs(random, transition.outputs)});
  }
  return net;
}

std::unique_ptr<NetExecutor> load(ExecutableNet net, NetExecutor::Options options) {
  std::string error;
  auto executor = NetExecutor::load(std::move(net), std::move(options), error);
  EXPECT_NE(executor, nullptr) << error;
  return executor;
}

}  // namespace tessera::testing
