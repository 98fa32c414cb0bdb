#pragma once

#include <cstdint>
#include <random>

#include "explore/formula.hpp"
#include "net/net.hpp"

namespace tessera::explore {

using Random = std::mt19937;

/// A number from 0 to limit - 1, the same on every platform.
[[nodiscard]] inline std::uint32_t below(Random& random, std::uint32_t limit) {
  return static_cast<std::uint32_t>(random() % limit);
}

/// State machines that share transitions; now and then an arc goes astray, so that some are unsafe.
[[nodiscard]] net::Net random_machines(Random& random);
/// Weights and several tokens; a firing seldom produces more than it consumes, so that most are bounded.
[[nodiscard]] net::Net random_weighted(Random& random);
/// Anything; many are unbounded.
[[nodiscard]] net::Net random_wild(Random& random);

[[nodiscard]] Formula random_formula(Random& random, const net::Net& net, int depth);

}  // namespace tessera::explore
