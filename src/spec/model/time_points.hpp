// Distributions of the times that calls take, as generated controllers draw from them.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

namespace tessera::spec {

using Duration = std::chrono::nanoseconds;

/// A point of a distribution: `below` of 2^32 calls take less than `time`. Between two neighbouring points all times are
/// equally likely.
struct TimePoint {
  Duration time{0};
  std::uint32_t below = 0;
  bool operator==(const TimePoint&) const = default;
};
inline constexpr std::uint32_t all_calls = std::numeric_limits<std::uint32_t>::max();

/// In ascending order of both; the first point has 0 below, the last one all_calls.
using TimePoints = std::vector<TimePoint>;

/// The normal distribution, cut off at the two ends and scaled up to 1 between them. Its cumulative distribution is
/// met to 0.0003. Preconditions: deviation > 0, shortest < longest, mean between them.
[[nodiscard]] TimePoints normal_points(Duration mean, Duration deviation, Duration shortest,
                                       Duration longest);

/// The distribution of measured times, by its 128-quantiles, and finer ones at both ends as far as the times tell.
/// Precondition: there is a time, and none is negative.
[[nodiscard]] TimePoints measured_points(std::vector<Duration> times);

}  // namespace tessera::spec
