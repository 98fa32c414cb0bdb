// Rates whose instants meet those of others too rarely to follow them one by one.
#pragma once

#include <optional>
#include <vector>

#include "timing/bounds.hpp"

namespace tessera::timing {

/// Because of this rate, the bounds of a chain are sums.
struct Drift {
  std::uint32_t subsystem = 0;
  Time period = 0;
  std::vector<Time> better;  ///< periods near it with which all repeats soon, the shorter one first
};

/// nullopt: the bounds of the chain are no sums, or not because of rates.
[[nodiscard]] std::optional<Drift> drift_of(const Bounds& bounds, const Chain& chain);

}  // namespace tessera::timing
