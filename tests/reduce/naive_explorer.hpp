#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "net/net.hpp"

namespace tessera::test {

using Tokens = std::vector<std::uint32_t>;

/// Is the transition enabled? And if so, the marking after it fired.
[[nodiscard]] std::optional<Tokens> fire(const net::Net& net, const Tokens& marking,
                                         net::TransitionId transition);
[[nodiscard]] Tokens initial(const net::Net& net);

/// All markings of a small net, as plainly as possible.
class NaiveExplorer {
 public:
  struct Firing {
    net::TransitionId transition;
    std::uint32_t to = 0;
  };

  /// nullopt if there are more markings than that.
  static std::optional<NaiveExplorer> explore(const net::Net& net, std::size_t most_markings);

  [[nodiscard]] const std::vector<Tokens>& markings() const { return markings_; }
  [[nodiscard]] bool safe() const;
  [[nodiscard]] std::optional<std::uint32_t> deadlock() const;
  /// From every marking, does some continuation fire one of the transitions?
  [[nodiscard]] bool can_always_fire(const std::set<net::TransitionId>& transitions) const;
  /// The combinations of tokens that the places reach.
  [[nodiscard]] std::set<Tokens> reached(const std::vector<net::PlaceId>& places) const;
  /// A firing sequence to the marking.
  [[nodiscard]] std::vector<net::TransitionId> trace_to(std::uint32_t marking) const;

 private:
  std::uint32_t number(const Tokens& marking, std::uint32_t from, net::TransitionId by);

  std::vector<Tokens> markings_;
  std::vector<std::vector<Firing>> firings_;  // per marking
  std::map<Tokens, std::uint32_t> numbers_;
  std::vector<std::pair<std::uint32_t, net::TransitionId>> reached_by_;  // per marking
};

}  // namespace tessera::test
