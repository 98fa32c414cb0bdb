#include "state_graph.hpp"

namespace oracle {

bool Marking::contains(const Marking& other) const {
  for (std::size_t w = 0; w < words; ++w)
    if ((other.bits[w] & ~bits[w]) != 0) return false;
  return true;
}
bool Marking::meets(const Marking& other) const {
  for (std::size_t w = 0; w < words; ++w)
    if ((other.bits[w] & bits[w]) != 0) return true;
  return false;
}
std::size_t MarkingHash::operator()(const Marking& marking) const {
  std::uint64_t hash = 0x9E3779B97F4A7C15U;
  for (const std::uint64_t word : marking.bits) {
    hash ^= word;
    hash *= 0xFF51AFD7ED558CCDU;
    hash ^= hash >> 32;
  }
  return hash;
}

StateGraph::StateGraph(const FlatNet& net, std::size_t limit) {
  for (const FlatTransition& transition : net.transitions) {
    Marking pre, post;
    for (const int place : transition.pre) pre.set(place);
    for (const int place : transition.post) post.set(place);
    pre_.push_back(pre);
    post_.push_back(post);
  }
  Marking initial;
  for (std::size_t p = 0; p < net.places.size(); ++p)
    if (net.places[p].marked) initial.set(static_cast<int>(p));
  markings_.push_back(initial);
  index_[initial] = 0;
  explore(limit);
  if (complete_) reverse();
}

bool StateGraph::enabled(const Marking& marking, int transition) const {
  return marking.contains(pre_[static_cast<std::size_t>(transition)]);
}

std::optional<Marking> StateGraph::fire(const Marking& marking, int transition) const {
  if (!enabled(marking, transition)) return std::nullopt;
  Marking after = marking;
  const auto t = static_cast<std::size_t>(transition);
  for (std::size_t w = 0; w < Marking::words; ++w)
    after.bits[w] = (after.bits[w] & ~pre_[t].bits[w]) | post_[t].bits[w];
  return after;
}

void StateGraph::explore(std::size_t limit) {
  for (std::size_t s = 0; s < markings_.size(); ++s) {
    if (markings_.size() > limit) {
      complete_ = false;
      return;
    }
    first_.push_back(static_cast<std::uint32_t>(edges_.size()));
    const Marking marking = markings_[s];
    for (int t = 0; t < static_cast<int>(pre_.size()); ++t) {
      const auto after = fire(marking, t);
      if (!after) continue;
      Marking rest = marking;
      for (std::size_t w = 0; w < Marking::words; ++w)
        rest.bits[w] &= ~pre_[static_cast<std::size_t>(t)].bits[w];
      if (rest.meets(post_[static_cast<std::size_t>(t)])) safe_ = false;  // a second token
      const auto [at, added] = index_.try_emplace(*after, static_cast<State>(markings_.size()));
      if (added) markings_.push_back(*after);
      edges_.push_back({at->second, t});
    }
  }
  first_.push_back(static_cast<std::uint32_t>(edges_.size()));
}

void StateGraph::reverse() {
  first_before_.assign(markings_.size() + 1, 0);
  for (const Edge& edge : edges_) ++first_before_[static_cast<std::size_t>(edge.to) + 1];
  for (std::size_t s = 0; s < markings_.size(); ++s) first_before_[s + 1] += first_before_[s];
  before_.resize(edges_.size());
  std::vector<std::uint32_t> next(first_before_.begin(), first_before_.end() - 1);
  for (std::size_t s = 0; s < markings_.size(); ++s)
    for (std::uint32_t e = first_[s]; e < first_[s + 1]; ++e)
      before_[next[static_cast<std::size_t>(edges_[e].to)]++] = static_cast<State>(s);
}

StateGraph::State StateGraph::find(const Marking& marking) const {
  const auto at = index_.find(marking);
  return at == index_.end() ? -1 : at->second;
}

StateGraph::Set StateGraph::where(const std::function<bool(const Marking&)>& holds) const {
  Set set(markings_.size());
  for (std::size_t s = 0; s < markings_.size(); ++s) set[s] = holds(markings_[s]) ? 1 : 0;
  return set;
}

StateGraph::Set StateGraph::where_enabled(const std::vector<char>& transitions) const {
  Set set(markings_.size());
  for (std::size_t s = 0; s < markings_.size(); ++s)
    for (std::uint32_t e = first_[s]; e < first_[s + 1]; ++e)
      if (transitions[static_cast<std::size_t>(edges_[e].transition)] != 0) set[s] = 1;
  return set;
}

StateGraph::Set StateGraph::can_reach(const Set& target, const Set& within) const {
  Set reached = target;
  std::vector<State> work;
  for (std::size_t s = 0; s < reached.size(); ++s)
    if (reached[s] != 0) work.push_back(static_cast<State>(s));
  while (!work.empty()) {
    const auto s = static_cast<std::size_t>(work.back());
    work.pop_back();
    for (std::uint32_t e = first_before_[s]; e < first_before_[s + 1]; ++e) {
      if (within[static_cast<std::size_t>(before_[e])] == 0) continue;
      char& seen = reached[static_cast<std::size_t>(before_[e])];
      if (seen == 0) work.push_back(before_[e]);
      seen = 1;
    }
  }
  return reached;
}

StateGraph::Set StateGraph::can_fire_for_ever(const std::vector<char>& transitions) const {
  const std::vector<int> component = strong_components();
  Set again(markings_.size());
  for (std::size_t s = 0; s < markings_.size(); ++s)
    for (std::uint32_t e = first_[s]; e < first_[s + 1]; ++e)
      if (transitions[static_cast<std::size_t>(edges_[e].transition)] != 0 &&
          component[s] == component[static_cast<std::size_t>(edges_[e].to)])
        again[s] = 1;
  return can_reach(again);
}

/// Kosaraju: states in the order in which a depth-first search leaves them, then backwards from the last.
std::vector<int> StateGraph::strong_components() const {
  std::vector<State> order;
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  std::vector<char> seen(markings_.size());
  std::vector<State> path{0};  // every state is reachable from the first
  seen[0] = 1;
  while (!path.empty()) {
    const auto s = static_cast<std::size_t>(path.back());
    if (next[s] == first_[s + 1]) {
      order.push_back(path.back());
      path.pop_back();
      continue;
    }
    const State to = edges_[next[s]++].to;
    if (seen[static_cast<std::size_t>(to)] == 0) path.push_back(to);
    seen[static_cast<std::size_t>(to)] = 1;
  }
  std::vector<int> component(markings_.size(), -1);
  int number = 0;
  for (auto root = order.rbegin(); root != order.rend(); ++root) {
    if (component[static_cast<std::size_t>(*root)] >= 0) continue;
    std::vector<State> work{*root};
    component[static_cast<std::size_t>(*root)] = number;
    while (!work.empty()) {
      const auto s = static_cast<std::size_t>(work.back());
      work.pop_back();
      for (std::uint32_t e = first_before_[s]; e < first_before_[s + 1]; ++e) {
        int& of = component[static_cast<std::size_t>(before_[e])];
        if (of < 0) work.push_back(before_[e]);
        if (of < 0) of = number;
      }
    }
    ++number;
  }
  return component;
}

}  // namespace oracle
