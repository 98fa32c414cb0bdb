#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explore/explore.hpp"
#include "verify/search/exploration.hpp"

namespace tessera::verify {

/// The question about a goal, a formula over places.
enum class Ask : std::uint8_t {
  reachable,         ///< Is a marking reachable in which `what` is true? yes: with a run.
  always_reachable,  ///< Can one be reached from every reachable marking? no: with a run to where none can.
  leads_to           ///< explore::leads_to. no: with a run to where `then` is out of reach.
};

struct Goal {
  explore::Formula what;
  explore::Formula then = explore::Formula::never();  ///< leads_to only
};

/// One answer for each goal, up to the first answer that is `stop_at` (nullopt: all). Later answers are
/// `unknown` without a reason. Only the parts of the reduced net that a goal concerns are explored. Among
/// parts and goals that are equal except for the agents, only one is explored.
[[nodiscard]] std::vector<Found> ask(const net::Net& net, Ask question, const std::vector<Goal>& goals,
                                     std::optional<Found::Kind> stop_at, const Reducing& how,
                                     const explore::Limits& limits);

}  // namespace tessera::verify
