#include "formula_oracle.hpp"

#include <algorithm>

#include "oracle/nets/of_net.hpp"

namespace tessera::explore {

using oracle::below;
using oracle::Random;

std::optional<ReachabilityGraph> naive_graph(const net::Net& net, std::size_t most) {
  return ReachabilityGraph::of(oracle::petri_net(net), most);
}

bool holds(const ReachabilityGraph& graph, const Formula& formula, ReachabilityGraph::State state) {
  const auto part_holds = [&](const Formula& part) { return holds(graph, part, state); };
  const auto is_the_transition = [&](const auto& edge) { return edge.transition == formula.node; };
  switch (formula.kind) {
    case Formula::Kind::at_least:
      return graph.marking(state)[formula.node] >= formula.tokens;
    case Formula::Kind::enabled:
      return std::ranges::any_of(graph.edges(state), is_the_transition);
    case Formula::Kind::dead:
      return graph.dead(state);
    case Formula::Kind::negation:
      return !part_holds(formula.parts.front());
    case Formula::Kind::all:
      return std::ranges::all_of(formula.parts, part_holds);
    case Formula::Kind::any:
      return std::ranges::any_of(formula.parts, part_holds);
  }
  return false;
}

ReachabilityGraph::States where(const ReachabilityGraph& graph, const Formula& formula) {
  ReachabilityGraph::States states(graph.size());
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state)
    states[state] = holds(graph, formula, state) ? 1 : 0;
  return states;
}

// States are numbered in breadth-first order: the first one is nearest.
std::optional<std::size_t> nearest(const ReachabilityGraph& graph, const Formula& formula) {
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state)
    if (holds(graph, formula, state)) return graph.run_to(state).size();
  return std::nullopt;
}

bool can_reach(const ReachabilityGraph& graph, ReachabilityGraph::State from, const Formula& goal) {
  return graph.can_reach(where(graph, goal))[from] != 0;
}

bool always_reachable(const ReachabilityGraph& graph, const Formula& goal) {
  return oracle::every(graph.can_reach(where(graph, goal)));
}

bool leads_to(const ReachabilityGraph& graph, const Formula& p, const Formula& q) {
  return !oracle::some(graph.losing(where(graph, p), where(graph, q)));
}

net::Net random_machines(Random& random) { return oracle::tessera_net(oracle::random_machines(random)); }
net::Net random_weighted(Random& random) { return oracle::tessera_net(oracle::random_weighted(random)); }
net::Net random_wild(Random& random) { return oracle::tessera_net(oracle::random_wild(random)); }

Formula random_formula(Random& random, const net::Net& net, int depth) {
  const auto places = static_cast<std::uint32_t>(net.places().size());
  const auto transitions = static_cast<std::uint32_t>(net.transitions().size());
  switch (below(random, depth > 0 ? 7 : 4)) {
    case 0:
    case 1: {
      const PlaceId place{below(random, places)};
      return Formula::at_least(place, below(random, 4));
    }
    case 2:
      return transitions > 0 ? Formula::enabled(TransitionId{below(random, transitions)}) : Formula::dead();
    case 3:
      return Formula::marked(PlaceId{below(random, places)});
    case 4:
      return Formula::negation(random_formula(random, net, depth - 1));
    case 5:
      return Formula::all({random_formula(random, net, depth - 1), random_formula(random, net, depth - 1)});
    default:
      return Formula::any({random_formula(random, net, depth - 1), random_formula(random, net, depth - 1)});
  }
}

}  // namespace tessera::explore
