#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "explore/formula.hpp"
#include "explore/watch.hpp"

namespace tessera::siphons {

struct Exclusion {
  enum class Kind : std::uint8_t {
    excluded,   ///< no reachable marking is like that
    suspected,  ///< a marking is not excluded; it need not be reachable
    gave_up     ///< `why`
  } kind = Kind::gave_up;
  std::string why;
  std::vector<net::PlaceId> marked;  ///< of suspected: the places that the marking marks
  std::size_t units = 0, traps = 0;  ///< that were used
};

/// Can a reachable marking be one of which `goal` is true? Asks for a marking that satisfies the goal, has
/// one token in every unit (explore/units.hpp), and one in every trap that is marked initially; the traps are
/// found one by one, each against the last marking that satisfied everything else. Where the goal is
/// Formula::dead(), the empty places of such a marking are a siphon without a marked trap.
///
/// Only whether places are marked is considered: of "holds two tokens or more" no more is known than that the
/// place is marked, and in no unit. Weights are therefore allowed, but say little.
///
/// Threads: pure. Time: that of a SAT solver, which exceeds limits.time by one step of the solver at most.
/// Source: Hack 1972; Esparza & Melzer, *Verification of safety properties using integer programming: beyond
/// the state equation*, FMSD 16, 2000, refine by traps in the same way.
[[nodiscard]] Exclusion exclude(const explore::PtNet& net, const explore::Formula& goal,
                                const explore::Limits& limits);

}  // namespace tessera::siphons
