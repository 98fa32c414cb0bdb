#pragma once

#include <cstdint>

#include "reduce/reduce.hpp"

namespace tessera::test {

/// A small net with what is to be preserved of it. Half of the nets are sequential processes that
/// synchronise, as robot systems are; the rest are arbitrary, with weights and several tokens.
/// The same seed gives the same case.
struct RandomCase {
  net::Net net;
  reduce::Preserve what;  ///< `safe` is not set
};
[[nodiscard]] RandomCase random_case(std::uint32_t seed);

}  // namespace tessera::test
