#pragma once

#include <cstdint>
#include <vector>

#include "explore/pt_net.hpp"

namespace tessera::explore {

/// A set of places of which at most one is marked, with one token, in every reachable marking.
struct Unit {
  std::vector<std::uint32_t> places;
  bool always_one = false;  ///< one of them is marked in every reachable marking
};

/// Disjoint units.
///
/// Each unit is part of a set of places with at most one token at first, to whose sum no firing adds, so it
/// is proved, not observed. Places in no unit are not known to be safe. The search is bounded: it is linear
/// in nets that are state machines joined by their transitions, and gives up on a place after a fixed number
/// of guesses.
///
/// Threads: pure.
[[nodiscard]] std::vector<Unit> find_units(const PtNet& net);

/// Every place is in one: the net is safe.
[[nodiscard]] bool units_cover(const PtNet& net);

}  // namespace tessera::explore
