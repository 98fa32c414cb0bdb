#include "oracle/nets/reachability_graph.hpp"

#include <algorithm>
#include <utility>

namespace oracle {

std::size_t MarkingHash::operator()(const Marking& marking) const {
  std::uint64_t hash = 0x9E3779B97F4A7C15U;
  for (const std::uint32_t tokens : marking) {
    hash ^= tokens;
    hash *= 0xFF51AFD7ED558CCDU;
    hash ^= hash >> 32;
  }
  return hash;
}

ReachabilityGraph::ReachabilityGraph(const PetriNet& net, std::size_t most) {
  explore(net, most);
  if (complete_) reverse();
}

std::optional<ReachabilityGraph> ReachabilityGraph::of(const PetriNet& net, std::size_t most) {
  ReachabilityGraph graph(net, most);
  if (!graph.complete()) return std::nullopt;
  return graph;
}

std::uint32_t ReachabilityGraph::number(Marking marking, Edge found_by) {
  const auto [entry, added] =
      numbers_.try_emplace(std::move(marking), static_cast<std::uint32_t>(markings_.size()));
  if (added) {
    markings_.push_back(&entry->first);
    found_by_.push_back(found_by);
  }
  return entry->second;
}

void ReachabilityGraph::explore(const PetriNet& net, std::size_t most) {
  number(net.initial, {0, 0});
  for (std::uint32_t state = 0; state < markings_.size(); ++state) {
    first_.push_back(edges_.size());
    for (std::uint32_t transition = 0; transition < net.transitions.size(); ++transition) {
      auto next = fired(net.transitions[transition], marking(state));
      if (!next) continue;
      edges_.push_back({number(std::move(*next), {state, transition}), transition});
      complete_ = markings_.size() <= most;
      if (!complete_) return;
    }
  }
  first_.push_back(edges_.size());
}

void ReachabilityGraph::reverse() {
  first_before_.assign(size() + 1, 0);
  for (const Edge& edge : edges_) ++first_before_[edge.to + 1];
  for (State state = 0; state < size(); ++state) first_before_[state + 1] += first_before_[state];
  before_.resize(edges_.size());
  std::vector<std::size_t> next(first_before_.begin(), first_before_.end() - 1);
  for (std::uint32_t state = 0; state < size(); ++state)
    for (const Edge& edge : edges(state)) before_[next[edge.to]++] = state;
}

std::optional<ReachabilityGraph::State> ReachabilityGraph::find(const Marking& marking) const {
  const auto at = numbers_.find(marking);
  if (at == numbers_.end()) return std::nullopt;
  return at->second;
}

std::span<const ReachabilityGraph::Edge> ReachabilityGraph::edges(State from) const {
  return edges().subspan(first_[from], first_[from + 1] - first_[from]);
}

std::uint32_t ReachabilityGraph::most_tokens() const {
  std::uint32_t most = 0;
  for (const Marking* marking : markings_)
    for (const std::uint32_t tokens : *marking) most = std::max(most, tokens);
  return most;
}

std::vector<std::uint32_t> ReachabilityGraph::run_to(State state) const {
  std::vector<std::uint32_t> run;
  for (; state != 0; state = found_by_[state].to) run.push_back(found_by_[state].transition);
  std::ranges::reverse(run);
  return run;
}

ReachabilityGraph::States ReachabilityGraph::where(const std::function<bool(const Marking&)>& holds) const {
  States states(size());
  for (State state = 0; state < size(); ++state) states[state] = holds(marking(state)) ? 1 : 0;
  return states;
}

ReachabilityGraph::States ReachabilityGraph::where_enabled(const Transitions& transitions) const {
  States states(size());
  for (State state = 0; state < size(); ++state)
    for (const Edge& edge : edges(state))
      if (transitions[edge.transition] != 0) states[state] = 1;
  return states;
}

ReachabilityGraph::States ReachabilityGraph::can_reach(const States& target, const States& within) const {
  States reached = target;
  std::vector<State> work;
  for (State state = 0; state < size(); ++state)
    if (reached[state] != 0) work.push_back(state);
  while (!work.empty()) {
    const State state = work.back();
    work.pop_back();
    for (std::size_t edge = first_before_[state]; edge < first_before_[state + 1]; ++edge) {
      const State from = before_[edge];
      if (within[from] == 0 || reached[from] != 0) continue;
      reached[from] = 1;
      work.push_back(from);
    }
  }
  return reached;
}

ReachabilityGraph::States ReachabilityGraph::losing(const States& p, const States& q) const {
  const States lost = can_reach(complement(can_reach(q)), complement(q));
  States losing(size());
  for (State state = 0; state < size(); ++state) losing[state] = p[state] != 0 && lost[state] != 0 ? 1 : 0;
  return losing;
}

ReachabilityGraph::States ReachabilityGraph::can_fire_for_ever(const Transitions& transitions) const {
  const std::vector<int> component = strong_components();
  States again(size());
  for (State state = 0; state < size(); ++state)
    for (const Edge& edge : edges(state))
      if (transitions[edge.transition] != 0 && component[state] == component[edge.to]) again[state] = 1;
  return can_reach(again);
}

/// The states in the order in which a depth-first search leaves them.
std::vector<ReachabilityGraph::State> ReachabilityGraph::in_order_of_leaving() const {
  std::vector<State> order;
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  States seen(size());
  std::vector<State> path{0};  // every state is reachable from the first
  seen[0] = 1;
  while (!path.empty()) {
    const State state = path.back();
    if (next[state] == first_[state + 1]) {
      order.push_back(state);
      path.pop_back();
      continue;
    }
    const State to = edges_[next[state]++].to;
    if (seen[to] == 0) path.push_back(to);
    seen[to] = 1;
  }
  return order;
}

/// Kosaraju: backwards from the state that a depth-first search leaves last.
std::vector<int> ReachabilityGraph::strong_components() const {
  const std::vector<State> order = in_order_of_leaving();
  std::vector<int> component(size(), -1);
  int number = 0;
  for (auto root = order.rbegin(); root != order.rend(); ++root) {
    if (component[*root] >= 0) continue;
    std::vector<State> work{*root};
    component[*root] = number;
    while (!work.empty()) {
      const State state = work.back();
      work.pop_back();
      for (std::size_t edge = first_before_[state]; edge < first_before_[state + 1]; ++edge) {
        int& of = component[before_[edge]];
        if (of < 0) work.push_back(before_[edge]);
        if (of < 0) of = number;
      }
    }
    ++number;
  }
  return component;
}

bool some(const ReachabilityGraph::States& states) {
  return std::ranges::any_of(states, [](char in) { return in != 0; });
}

bool every(const ReachabilityGraph::States& states) {
  return std::ranges::all_of(states, [](char in) { return in != 0; });
}

ReachabilityGraph::States complement(ReachabilityGraph::States states) {
  for (char& in : states) in = in == 0 ? 1 : 0;
  return states;
}

}  // namespace oracle
