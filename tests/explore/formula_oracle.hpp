#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "explore/formula.hpp"
#include "net/net.hpp"
#include "oracle/nets/random_net.hpp"
#include "oracle/nets/reachability_graph.hpp"

/// Questions about formulas, answered by looking at every reachable marking. Only the form of a formula is
/// that of the explorer.
namespace tessera::explore {

using oracle::ReachabilityGraph;

/// All markings of a net; nullopt: there are more than `most`.
[[nodiscard]] std::optional<ReachabilityGraph> naive_graph(const net::Net& net, std::size_t most);

[[nodiscard]] bool holds(const ReachabilityGraph& graph, const Formula& formula,
                         ReachabilityGraph::State state);
[[nodiscard]] ReachabilityGraph::States where(const ReachabilityGraph& graph, const Formula& formula);
/// The firings of a shortest run to a marking of which the formula is true.
[[nodiscard]] std::optional<std::size_t> nearest(const ReachabilityGraph& graph, const Formula& formula);
[[nodiscard]] bool can_reach(const ReachabilityGraph& graph, ReachabilityGraph::State from,
                             const Formula& goal);
[[nodiscard]] bool always_reachable(const ReachabilityGraph& graph, const Formula& goal);
[[nodiscard]] bool leads_to(const ReachabilityGraph& graph, const Formula& p, const Formula& q);

/// A net of one of the families of oracle/nets/random_net.hpp.
[[nodiscard]] net::Net random_machines(oracle::Random& random);
[[nodiscard]] net::Net random_weighted(oracle::Random& random);
[[nodiscard]] net::Net random_wild(oracle::Random& random);
[[nodiscard]] Formula random_formula(oracle::Random& random, const net::Net& net, int depth);

}  // namespace tessera::explore
