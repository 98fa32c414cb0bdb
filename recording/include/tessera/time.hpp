#pragma once

// Durations and clocks are a seventh of <chrono>, whose streams and calendars would be most of what a small generated
// source compiles.
#if defined(TESSERA_ONLY_DURATIONS) && __has_include(<bits/chrono.h>)
#include <bits/chrono.h>
#else
#include <chrono>
#endif

namespace tessera {

using Duration = std::chrono::nanoseconds;

/// The time since the start of the run. Under the simulated clock, only the simulation advances it.
struct RunClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<RunClock, duration>;
  static constexpr bool is_steady = true;
};
using Time = RunClock::time_point;

/// Seconds as a floating-point number.
[[nodiscard]] constexpr double seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace tessera
