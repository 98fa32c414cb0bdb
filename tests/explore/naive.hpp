#pragma once

#include <map>
#include <optional>
#include <vector>

#include "explore/explore.hpp"
#include "net/net.hpp"

namespace tessera::explore {

/// The reachability graph as the textbook has it: the oracle. Slow, and plain enough to be believed. It reads
/// the flat net itself, not what the explorer compiles of it.
class NaiveGraph {
 public:
  /// nullopt: there are more than `most` markings.
  static std::optional<NaiveGraph> of(const net::Net& net, std::size_t most);

  [[nodiscard]] std::size_t size() const { return markings_.size(); }
  [[nodiscard]] std::size_t edges() const;
  [[nodiscard]] Tokens most_tokens() const;
  [[nodiscard]] const Marking& marking(std::size_t index) const { return markings_[index]; }
  [[nodiscard]] std::optional<std::size_t> index_of(const Marking& marking) const;
  /// Firings of a shortest run to the marking.
  [[nodiscard]] std::size_t depth(std::size_t index) const { return depths_[index]; }

  [[nodiscard]] bool holds(const Formula& formula, std::size_t index) const;
  /// The depth of the first marking of which the formula is true.
  [[nodiscard]] std::optional<std::size_t> nearest(const Formula& formula) const;
  /// Whether some marking that holds the formula can be reached, without passing one that holds `avoiding` on
  /// the way (the two ends included).
  [[nodiscard]] bool can_reach(std::size_t from, const Formula& goal, const Formula& avoiding) const;
  [[nodiscard]] bool always_reachable(const Formula& goal) const;
  [[nodiscard]] bool leads_to(const Formula& p, const Formula& q) const;

 private:
  NaiveGraph() = default;
  [[nodiscard]] std::vector<char> reachable(std::size_t from, const Formula& avoiding) const;

  struct Edge {
    std::size_t transition, target;
  };
  std::vector<Marking> markings_;
  std::map<Marking, std::size_t> indices_;
  std::vector<std::vector<Edge>> successors_;
  std::vector<std::size_t> depths_;
};

/// The marking after a transition; nullopt if it is not enabled.
[[nodiscard]] std::optional<Marking> fired(const net::Net& net, TransitionId transition,
                                           const Marking& marking);

}  // namespace tessera::explore
