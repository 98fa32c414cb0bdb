#pragma once

#include <cstdint>
#include <vector>

#include "explore/pt_net.hpp"

namespace tessera::explore {

/// A set of places. In every reachable marking, at most one of them is marked, with one token.
struct Unit {
  std::vector<std::uint32_t> places;
  bool always_one = false;  ///< one of the places is marked in every reachable marking
};

/// Disjoint units.
///
/// Each unit is part of a set of places with at most one token at first, and no firing increases the sum of
/// its tokens. So it is proved, not observed. Places in no unit are not known to be safe. The search is
/// bounded: it is linear in nets that consist of state machines joined by their transitions, and it gives up
/// a place after a fixed number of guesses, and all places after a fixed number of steps.
///
/// Threads: pure.
[[nodiscard]] std::vector<Unit> find_units(const PtNet& net);

/// Whether every place is in a unit. Then the net is safe.
[[nodiscard]] bool units_cover(const PtNet& net);

}  // namespace tessera::explore
