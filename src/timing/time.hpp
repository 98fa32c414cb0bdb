// Times of the analysis, and sums that stay unbounded.
#pragma once

#include <cstdint>

namespace tessera::timing {

using Time = std::int64_t;  ///< nanoseconds
/// More than any bound: there is none. Far from the limits of the type, so that a few can be added.
inline constexpr Time unbounded = std::int64_t{1} << 60;

[[nodiscard]] constexpr Time plus(Time a, Time b) {
  return a >= unbounded || b >= unbounded || a + b >= unbounded ? unbounded : a + b;
}
[[nodiscard]] constexpr Time minus(Time a, Time b) { return a >= unbounded ? unbounded : a - b; }
/// Rounded up. Precondition: b > 0.
[[nodiscard]] constexpr Time ceil_div(Time a, Time b) { return a >= 0 ? (a + b - 1) / b : -((-a) / b); }
/// Rounded down. Precondition: b > 0.
[[nodiscard]] constexpr Time floor_div(Time a, Time b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace tessera::timing
