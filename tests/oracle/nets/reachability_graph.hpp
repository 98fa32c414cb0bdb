// Every reachable marking of a net, visited one by one, with all edges: slow, large and hard to get wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "oracle/nets/petri_net.hpp"

namespace oracle {

struct MarkingHash {
  std::size_t operator()(const Marking& marking) const;
};

/// The states are the reachable markings, numbered as a breadth-first search finds them; 0 is the initial
/// one.
class ReachabilityGraph {
 public:
  using State = std::size_t;
  using States = std::vector<char>;       ///< a set: one entry per state
  using Transitions = std::vector<char>;  ///< a set: one entry per transition
  struct Edge {
    std::uint32_t to, transition;
  };

  /// Visits all markings of `net`, or stops after `most`. Then `complete()` is false, and only size() and
  /// marking() may be asked.
  ReachabilityGraph(const PetriNet& net, std::size_t most);
  /// nullopt: there are more than `most` markings.
  static std::optional<ReachabilityGraph> of(const PetriNet& net, std::size_t most);

  ReachabilityGraph(const ReachabilityGraph&) = delete;  // markings_ points into numbers_
  ReachabilityGraph& operator=(const ReachabilityGraph&) = delete;
  ReachabilityGraph(ReachabilityGraph&&) = default;
  ReachabilityGraph& operator=(ReachabilityGraph&&) = default;
  ~ReachabilityGraph() = default;

  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] std::size_t size() const { return markings_.size(); }
  [[nodiscard]] const Marking& marking(State state) const { return *markings_[state]; }

  [[nodiscard]] std::optional<State> find(const Marking& marking) const;
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  [[nodiscard]] std::span<const Edge> edges(State from) const;
  [[nodiscard]] bool dead(State state) const { return edges(state).empty(); }
  [[nodiscard]] std::uint32_t most_tokens() const;
  [[nodiscard]] bool safe() const { return most_tokens() <= 1; }
  /// The transitions of a shortest run to the state.
  [[nodiscard]] std::vector<std::uint32_t> run_to(State state) const;

  [[nodiscard]] States where(const std::function<bool(const Marking&)>& holds) const;
  /// The states in which one of these transitions is enabled.
  [[nodiscard]] States where_enabled(const Transitions& transitions) const;
  /// The states from which one of `target` can be reached, `target` itself included.
  [[nodiscard]] States can_reach(const States& target) const { return can_reach(target, States(size(), 1)); }
  /// The same by way of states in `within` only, the first one included; `target` counts wherever it is.
  [[nodiscard]] States can_reach(const States& target, const States& within) const;
  /// The states of `p` from which a run that meets no `q` leads to where `q` can never be reached: `p` leads
  /// to `q` if there are none.
  [[nodiscard]] States losing(const States& p, const States& q) const;
  /// The states from which one of these transitions can fire for ever, again and again.
  [[nodiscard]] States can_fire_for_ever(const Transitions& transitions) const;

 private:
  std::uint32_t number(Marking marking, Edge found_by);
  void explore(const PetriNet& net, std::size_t most);
  void reverse();
  [[nodiscard]] std::vector<State> in_order_of_leaving() const;
  [[nodiscard]] std::vector<int> strong_components() const;

  std::unordered_map<Marking, std::uint32_t, MarkingHash> numbers_;
  std::vector<const Marking*> markings_;
  std::vector<Edge> found_by_;      // per state: `to` is the state it was found from
  std::vector<std::size_t> first_;  // per state: its first edge
  std::vector<Edge> edges_;         // by the state they come from
  std::vector<std::size_t> first_before_;
  std::vector<std::uint32_t> before_;  // per edge, by the state it leads to: where it comes from
  bool complete_ = true;
};

[[nodiscard]] bool some(const ReachabilityGraph::States& states);
[[nodiscard]] bool every(const ReachabilityGraph::States& states);
[[nodiscard]] ReachabilityGraph::States complement(ReachabilityGraph::States states);

}  // namespace oracle
