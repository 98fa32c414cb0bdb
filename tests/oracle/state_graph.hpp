// Every reachable marking of a net, visited one by one, with all edges: slow, large and hard to get wrong.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "flat_net.hpp"

namespace oracle {

/// The places that hold a token. Nets of more than `capacity` places are not searched.
struct Marking {
  static constexpr int words = 5, capacity = words * 64;
  std::array<std::uint64_t, words> bits{};
  bool has(int place) const { return (bits[static_cast<std::size_t>(place) / 64] >> (place % 64) & 1U) != 0; }
  void set(int place) { bits[static_cast<std::size_t>(place) / 64] |= std::uint64_t{1} << (place % 64); }
  bool contains(const Marking& other) const;
  bool meets(const Marking& other) const;
  friend bool operator==(const Marking&, const Marking&) = default;
};
struct MarkingHash {
  std::size_t operator()(const Marking& marking) const;
};

class StateGraph {
 public:
  using State = int;
  using Set = std::vector<char>;  // one entry per state
  struct Edge {
    State to;
    int transition;
  };

  /// Visits all of `net`, or stops after `limit` markings. Then `complete()` is false, and no
  /// other function may be called.
  StateGraph(const FlatNet& net, std::size_t limit);

  bool complete() const { return complete_; }
  bool safe() const { return safe_; }
  std::size_t size() const { return markings_.size(); }
  const Marking& marking(State state) const { return markings_[static_cast<std::size_t>(state)]; }
  State find(const Marking& marking) const;  // -1: not reachable
  bool dead(State state) const {
    return first_[static_cast<std::size_t>(state)] == first_[static_cast<std::size_t>(state) + 1];
  }
  Marking initial() const { return markings_[0]; }
  bool enabled(const Marking& marking, int transition) const;
  /// Nothing if it is not enabled.
  std::optional<Marking> fire(const Marking& marking, int transition) const;

  Set where(const std::function<bool(const Marking&)>& holds) const;
  /// The states in which one of these transitions is enabled.
  Set where_enabled(const std::vector<char>& transitions) const;
  /// The states from which one of `target` can be reached, `target` itself included.
  Set can_reach(const Set& target) const { return can_reach(target, Set(size(), 1)); }
  /// The same by way of states in `within` only, the first one included; `target` counts wherever it is.
  Set can_reach(const Set& target, const Set& within) const;
  /// The states from which one of these transitions can fire for ever, again and again.
  Set can_fire_for_ever(const std::vector<char>& transitions) const;

 private:
  void explore(std::size_t limit);
  void reverse();
  std::vector<int> strong_components() const;

  std::vector<Marking> pre_, post_;
  std::vector<Marking> markings_;
  std::unordered_map<Marking, State, MarkingHash> index_;
  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> first_before_;
  std::vector<State> before_;
  bool complete_ = true, safe_ = true;
};

}  // namespace oracle
