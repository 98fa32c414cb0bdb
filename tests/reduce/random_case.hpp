#pragma once

#include <cstdint>

#include "reduce/reduce.hpp"

namespace tessera::test {

/// A small net with the properties to preserve. Half of the nets are sequential processes that synchronise,
/// as in robot systems; the rest are arbitrary, with weights and several tokens. The same seed gives the same
/// case.
struct RandomCase {
  net::Net net;
  reduce::Preserve what;  ///< `safe` is not set
};
[[nodiscard]] RandomCase random_case(std::uint32_t seed);

}  // namespace tessera::test
