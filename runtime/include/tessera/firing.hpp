#pragma once

#include <cstdint>

/// The firing rule of place/transition nets, defined once for the explorer and the general executor. Both
/// add faster ways to apply it (packed markings, incremental enabling).
namespace tessera::firing {

using Tokens = std::uint32_t;

/// Whether a place that holds `held` tokens lets a transition take `taken`. A transition is enabled if
/// all its input places let it.
[[nodiscard]] constexpr bool suffices(Tokens held, Tokens taken) { return held >= taken; }

/// The tokens of a place after a firing that takes and gives. Precondition: suffices(held, taken).
[[nodiscard]] constexpr Tokens after(Tokens held, Tokens taken, Tokens given) { return held - taken + given; }

}  // namespace tessera::firing
