#pragma once

#include <cstdint>

/// The rule of firing of place/transition nets, said once for the explorer and the general executor. What
/// they add (packed markings, incremental enabling) are ways to apply it fast.
namespace tessera::firing {

using Tokens = std::uint32_t;

/// Whether a place that holds `held` tokens lets a transition take `taken`; enabled is what all its places
/// let.
[[nodiscard]] constexpr bool suffices(Tokens held, Tokens taken) { return held >= taken; }

/// What a place holds after a firing that takes and gives. Precondition: suffices(held, taken).
[[nodiscard]] constexpr Tokens after(Tokens held, Tokens taken, Tokens given) { return held - taken + given; }

}  // namespace tessera::firing
