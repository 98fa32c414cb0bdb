#include "naive_net.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <map>

namespace tessera::testing {
namespace {

using Ends = std::map<std::uint32_t, std::uint32_t>;  // place -> weight

[[nodiscard]] Ends ends_of(const std::vector<ExecutableNet::Arc>& arcs) {
  Ends ends;
  for (const ExecutableNet::Arc& arc : arcs) ends[arc.place] += arc.weight;
  return ends;
}

[[nodiscard]] std::uint32_t below(Random& random, std::uint32_t limit) {
  return static_cast<std::uint32_t>(random() % limit);
}

[[nodiscard]] std::vector<ExecutableNet::Arc> random_arcs(Random& random, std::uint32_t places,
                                                          std::uint32_t most, std::uint32_t most_weight) {
  std::vector<ExecutableNet::Arc> arcs;
  for (std::uint32_t end = below(random, most + 1); end > 0; --end)
    arcs.push_back({below(random, places), 1 + below(random, most_weight)});
  return arcs;
}

/// State machines that share transitions: mostly safe, and most of their transitions need little.
[[nodiscard]] ExecutableNet random_machines(Random& random) {
  ExecutableNet net;
  const std::uint32_t machines = 1 + below(random, 4), states = 2 + below(random, 3);
  net.places.resize(std::size_t{machines} * states);
  for (std::uint32_t machine = 0; machine < machines; ++machine)
    net.places[machine * states + below(random, states)].tokens = 1;
  for (std::uint32_t left = 2 + below(random, machines * states); left > 0; --left) {
    ExecutableNet::Transition transition;
    for (std::uint32_t taking_part = 1 + below(random, 2); taking_part > 0; --taking_part) {
      const std::uint32_t machine = below(random, machines);
      transition.inputs.push_back({machine * states + below(random, states)});
      transition.outputs.push_back({machine * states + below(random, states)});
    }
    net.transitions.push_back(std::move(transition));
  }
  return net;
}

[[nodiscard]] ExecutableNet random_weighted(Random& random) {
  ExecutableNet net;
  const std::uint32_t places = 1 + below(random, 6);
  net.places.resize(places);
  for (ExecutableNet::Place& place : net.places) place.tokens = below(random, 3) * below(random, 3);
  for (std::uint32_t left = below(random, 8); left > 0; --left) {
    ExecutableNet::Transition transition{.inputs = random_arcs(random, places, 3, 2),
                                         .outputs = random_arcs(random, places, 3, 2)};
    if (transition.outputs.size() > transition.inputs.size() && below(random, 8) != 0)
      transition.outputs.resize(transition.inputs.size());
    net.transitions.push_back(std::move(transition));
  }
  return net;
}

}  // namespace

NaiveNet::NaiveNet(const ExecutableNet& net) : net_(net) {
  for (const ExecutableNet::Place& place : net.places) marking_.push_back(place.tokens);
}

bool NaiveNet::enabled(std::uint32_t transition) const {
  for (const auto& [place, weight] : ends_of(net_.transitions[transition].inputs))
    if (marking_[place] < weight) return false;
  return true;
}

std::vector<std::uint32_t> NaiveNet::enabled() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t transition = 0; transition < net_.transitions.size(); ++transition)
    if (enabled(transition)) result.push_back(transition);
  return result;
}

bool NaiveNet::fire(std::uint32_t transition) {
  if (!enabled(transition)) return false;
  for (const auto& [place, weight] : ends_of(net_.transitions[transition].inputs)) marking_[place] -= weight;
  for (const auto& [place, weight] : ends_of(net_.transitions[transition].outputs)) marking_[place] += weight;
  return true;
}

std::optional<NaiveNet::Outcomes> NaiveNet::outcomes(std::size_t most, std::uint32_t most_tokens) const {
  Outcomes result{{marking_}, {}};
  std::deque<Marking> open{marking_};
  for (; !open.empty(); open.pop_front()) {
    NaiveNet here = *this;
    here.marking_ = open.front();
    const std::vector<std::uint32_t> ways = here.enabled();
    if (ways.empty()) result.dead.insert(open.front());
    for (const std::uint32_t transition : ways) {
      NaiveNet next = here;
      if (!next.fire(transition)) continue;
      for (const std::uint32_t tokens : next.marking_)
        if (tokens > most_tokens) return std::nullopt;
      if (result.reachable.insert(next.marking_).second) open.push_back(next.marking_);
      if (result.reachable.size() > most) return std::nullopt;
    }
  }
  return result;
}

ExecutableNet random_net(Random& random) {
  return below(random, 2) == 0 ? random_machines(random) : random_weighted(random);
}

std::unique_ptr<NetExecutor> load(ExecutableNet net, NetExecutor::Options options) {
  std::string error;
  auto executor = NetExecutor::load(std::move(net), std::move(options), error);
  EXPECT_NE(executor, nullptr) << error;
  return executor;
}

std::uint32_t number_from(const char* variable, std::uint32_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

}  // namespace tessera::testing
