#pragma once

#include <chrono>

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
