#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/executable_net.hpp"
#include "tessera/ids.hpp"

namespace tessera {

/// A net compiled for a NetExecutor: rows of 32-bit numbers, renumbered in the order in which tokens move,
/// so that consecutive firings touch neighbouring memory, whatever the order in the net. Immutable.
///
/// Two kinds of transitions need less than the general rule:
/// * *Sole*: takes one token from one place from which no other transition takes, has no condition,
///   and does not give a token back to that place. It is enabled exactly when that place is marked, so
///   nothing is counted for it.
/// * *Direct*: sole, and gives one token to one place without an operation, from which only another sole
///   transition takes. Such a firing is one record: from, to, and the transition that it enables.
struct FiringProgram {
  using TransitionId = Id<struct FiringTransitionTag>;  ///< own number
  using ConditionId = Id<struct FiringConditionTag>;    ///< its transition in the net

  /// The data of a direct firing. A sole transition has only `from`, another one none of them.
  struct Hop {
    enum class Kind : std::uint32_t { general, sole, direct } kind = Kind::general;
    std::uint32_t from = 0, to = 0;
    std::uint32_t next = 0;  ///< the transition that takes from `to`
  };
  /// The data of the general rule.
  struct Arcs {
    std::uint32_t takes = 0, takes_end = 0;  ///< into takes
    std::uint32_t gives = 0, gives_end = 0;  ///< into gives
    ConditionId condition{};                 ///< none: it has none
    bool operates = false;                   ///< gives a token to a place with an operation
  };
  struct Take {
    std::uint32_t place, weight;
  };
  struct Give {
    std::uint32_t place, weight;
    std::uint32_t taken;  ///< by the same transition from the same place
  };
  struct Consumer {
    std::uint32_t transition, weight;
  };
  struct PlaceRecord {
    TransitionId sole{};                ///< the sole transition that takes from it; otherwise:
    std::uint32_t first = 0, last = 0;  ///< into consumers
    bool operates = false;
  };

  std::vector<Hop> hops;   ///< per transition
  std::vector<Arcs> arcs;  ///< per transition
  std::vector<PlaceRecord> places;
  std::vector<Take> takes;
  std::vector<Give> gives;
  std::vector<Consumer> consumers;
  std::vector<std::uint32_t> rank;  ///< per transition; 0 has the highest priority
  std::uint32_t ranks = 1;
  std::vector<std::uint32_t> original_transition, original_place;    ///< index in the net, per own number
  std::vector<std::uint32_t> number_of_transition, number_of_place;  ///< the inverse
};

/// Errors: see NetExecutor::load.
[[nodiscard]] std::optional<FiringProgram> compile(const ExecutableNet& net, std::uint32_t bound,
                                                   std::string& error);

}  // namespace tessera
