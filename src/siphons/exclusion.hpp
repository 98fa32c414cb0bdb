#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/formula.hpp"
#include "explore/watch.hpp"

namespace tessera::siphons {

struct Exclusion {
  enum class Kind : std::uint8_t {
    excluded,   ///< no reachable marking satisfies the goal
    suspected,  ///< a marking is not excluded; it need not be reachable
    gave_up     ///< `why`
  } kind = Kind::gave_up;
  std::string why;
  std::vector<net::PlaceId> marked;  ///< if suspected: the marked places of that marking
  std::size_t units = 0, traps = 0;  ///< number of those that were used
};

/// Limits that do not depend on the speed of the machine.
struct Steps {
  std::optional<int> conflicts{};      ///< of the solver, between two traps
  std::optional<std::size_t> traps{};  ///< that are looked for
};

/// Can a reachable marking satisfy `goal`? Searches for a marking that satisfies the goal, has one token in
/// every unit (explore/units.hpp), and one in every trap that is marked initially. The traps are found one
/// by one, each against the last marking that satisfied everything else. If the goal is Formula::dead(),
/// the empty places of such a marking are a siphon without a marked trap.
///
/// The clauses only say whether places are marked. "Holds two tokens or more" only implies that the place
/// is marked and in no unit. So weights are allowed, but add little information.
///
/// Threads: pure. Time: that of a SAT solver. It ends at the limits and after the steps, whichever is first.
/// Source: Hack 1972; Esparza & Melzer, *Verification of safety properties using integer programming:
///         beyond the state equation*, FMSD 16, 2000, which refines by traps in the same way.
[[nodiscard]] Exclusion exclude(const explore::PtNet& net, const explore::Formula& goal,
                                const explore::Limits& limits, const Steps& steps = {});

}  // namespace tessera::siphons
