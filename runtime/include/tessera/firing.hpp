#pragma once

#include <cstdint>

/// The firing rule of place/transition nets, defined once for the explorer and the general executor. Both
/// add faster ways to apply it (packed markings, incremental enabling).
namespace tessera::firing {

using Tokens = std::uint32_t;

/// Whether a transition can take `taken` tokens from a place that holds `held`. It is enabled if it can take
/// its tokens from all its input places.
[[nodiscard]] constexpr bool suffices(Tokens held, Tokens taken) { return held >= taken; }

/// The tokens of a place after a firing that takes and gives. Precondition: suffices(held, taken).
[[nodiscard]] constexpr Tokens after(Tokens held, Tokens taken, Tokens given) { return held - taken + given; }

}  // namespace tessera::firing
