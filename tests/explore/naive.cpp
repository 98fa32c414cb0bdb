#include "naive.hpp"

#include <algorithm>

namespace tessera::explore {

std::optional<Marking> fired(const net::Net& net, TransitionId transition, const Marking& marking) {
  Marking next = marking;
  for (const net::Arc& arc : net.preset(transition)) {
    if (next[arc.place.value] < arc.weight) return std::nullopt;
    next[arc.place.value] -= arc.weight;
  }
  for (const net::Arc& arc : net.postset(transition)) next[arc.place.value] += arc.weight;
  return next;
}

std::optional<NaiveGraph> NaiveGraph::of(const net::Net& net, std::size_t most) {
  NaiveGraph graph;
  Marking initial;
  for (const net::Place& place : net.places()) initial.push_back(place.tokens);
  graph.markings_.push_back(initial);
  graph.indices_[initial] = 0;
  graph.depths_.push_back(0);
  for (std::size_t at = 0; at < graph.markings_.size(); ++at) {
    graph.successors_.emplace_back();
    for (std::uint32_t transition = 0; transition < net.transitions().size(); ++transition) {
      const std::optional<Marking> next = fired(net, TransitionId{transition}, graph.markings_[at]);
      if (!next) continue;
      const auto [known, fresh] = graph.indices_.try_emplace(*next, graph.markings_.size());
      if (fresh) {
        if (graph.markings_.size() == most) return std::nullopt;
        graph.markings_.push_back(*next);
        graph.depths_.push_back(graph.depths_[at] + 1);
      }
      graph.successors_[at].push_back({transition, known->second});
    }
  }
  return graph;
}

std::size_t NaiveGraph::edges() const {
  std::size_t sum = 0;
  for (const auto& edges : successors_) sum += edges.size();
  return sum;
}

Tokens NaiveGraph::most_tokens() const {
  Tokens most = 0;
  for (const Marking& marking : markings_)
    for (const Tokens tokens : marking) most = std::max(most, tokens);
  return most;
}

std::optional<std::size_t> NaiveGraph::index_of(const Marking& marking) const {
  const auto found = indices_.find(marking);
  if (found == indices_.end()) return std::nullopt;
  return found->second;
}

bool NaiveGraph::holds(const Formula& formula, std::size_t index) const {
  const auto part_holds = [&](const Formula& part) { return holds(part, index); };
  switch (formula.kind) {
    case Formula::Kind::at_least:
      return markings_[index][formula.node] >= formula.tokens;
    case Formula::Kind::enabled:
      return std::ranges::any_of(successors_[index],
                                 [&](const Edge& edge) { return edge.transition == formula.node; });
    case Formula::Kind::dead:
      return successors_[index].empty();
    case Formula::Kind::negation:
      return !part_holds(formula.parts.front());
    case Formula::Kind::all:
      return std::ranges::all_of(formula.parts, part_holds);
    case Formula::Kind::any:
      return std::ranges::any_of(formula.parts, part_holds);
  }
  return false;
}

std::optional<std::size_t> NaiveGraph::nearest(const Formula& formula) const {
  for (std::size_t index = 0; index < size(); ++index)
    if (holds(formula, index)) return depths_[index];
  return std::nullopt;
}

std::vector<char> NaiveGraph::reachable(std::size_t from, const Formula& avoiding) const {
  std::vector<char> seen(size(), 0);
  if (holds(avoiding, from)) return seen;
  std::vector<std::size_t> open{from};
  seen[from] = 1;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    for (const Edge& edge : successors_[at]) {
      if (seen[edge.target] != 0 || holds(avoiding, edge.target)) continue;
      seen[edge.target] = 1;
      open.push_back(edge.target);
    }
  }
  return seen;
}

bool NaiveGraph::can_reach(std::size_t from, const Formula& goal, const Formula& avoiding) const {
  const std::vector<char> seen = reachable(from, avoiding);
  for (std::size_t index = 0; index < size(); ++index)
    if (seen[index] != 0 && holds(goal, index)) return true;
  return false;
}

bool NaiveGraph::always_reachable(const Formula& goal) const {
  for (std::size_t index = 0; index < size(); ++index)
    if (!can_reach(index, goal, Formula::never())) return false;
  return true;
}

bool NaiveGraph::leads_to(const Formula& p, const Formula& q) const {
  std::vector<char> lost(size(), 0);
  for (std::size_t index = 0; index < size(); ++index) lost[index] = !can_reach(index, q, Formula::never());
  for (std::size_t index = 0; index < size(); ++index) {
    if (!holds(p, index)) continue;
    const std::vector<char> seen = reachable(index, q);
    for (std::size_t end = 0; end < size(); ++end)
      if (seen[end] != 0 && lost[end] != 0) return false;
  }
  return true;
}

}  // namespace tessera::explore
