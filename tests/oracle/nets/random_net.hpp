// Small random nets of several families. The same numbers give the same net on every platform.
#pragma once

#include <cstdint>
#include <random>

#include "oracle/nets/petri_net.hpp"

namespace oracle {

using Random = std::mt19937;

/// A number from 0 to limit - 1, the same on every platform.
[[nodiscard]] inline std::uint32_t below(Random& random, std::uint32_t limit) {
  return static_cast<std::uint32_t>(random() % limit);
}

/// State machines that share transitions; now and then an arc goes astray, so that some are unsafe.
[[nodiscard]] PetriNet random_machines(Random& random);
/// Sequential processes, closed or not, that synchronise by buffers of one or no token, as robot systems do.
[[nodiscard]] PetriNet random_processes(Random& random);
/// Weights and several tokens; a firing seldom produces more than it consumes, so that most are bounded.
[[nodiscard]] PetriNet random_weighted(Random& random);
/// Few arcs: at most two on each side of a transition, some of weight 2.
[[nodiscard]] PetriNet random_sparse(Random& random);
/// Arbitrary nets; many are unbounded.
[[nodiscard]] PetriNet random_wild(Random& random);

}  // namespace oracle
