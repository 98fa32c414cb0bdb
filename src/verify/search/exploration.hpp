#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/explore.hpp"
#include "net/net.hpp"
#include "reduce/components.hpp"
#include "reduce/reduce.hpp"

/// Answers questions by reducing a net, dividing it into parts, and exploring one part of each kind.
namespace tessera::verify {

struct Found {
  enum class Kind : std::uint8_t { yes, no, unknown } kind = Kind::unknown;
  std::string why;                       ///< for unknown
  std::vector<net::TransitionId> trace;  ///< for the answer that a run can show; in the given net
  std::uint64_t states = 0;
  std::string explanation;  ///< sizes before and after
  bool cut_short = false;   ///< the time ended before the trace was shortened
};

/// How a net may be reduced.
struct Reducing {
  bool safe = false;  ///< the net is known to be safe
  reduce::Rules rules = {};
};

/// Is a dead marking reachable in which `final_place` (if valid) is not marked? yes: with a run.
[[nodiscard]] Found find_dead(const net::Net& net, net::PlaceId final_place, const Reducing& how,
                              const explore::Limits& limits);

/// For each set: can one of its transitions be fired, at once or later, from every reachable marking? no:
/// with a run to a marking from which none can.
[[nodiscard]] std::vector<Found> find_stuck(const net::Net& net,
                                            const std::vector<std::vector<net::TransitionId>>& sets,
                                            const Reducing& how, const explore::Limits& limits);

/// "900 places and 800 transitions, reduced to ... in 3 parts of 2 kinds"
[[nodiscard]] std::string sizes(const reduce::Reduced& reduced, const reduce::Components& components);

}  // namespace tessera::verify
