#include "spec/model/time_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tessera::spec {
namespace {

constexpr int time_parts = 128;
/// Less than one of 2^32 calls is farther from the mean.
constexpr double farthest_deviations = 6.5;

double ns_of(Duration time) { return static_cast<double>(time.count()); }
Duration time_of(double ns) { return Duration(std::llround(ns)); }

std::uint32_t share_of_calls(double share) {
  return static_cast<std::uint32_t>(std::llround(std::clamp(share, 0.0, 1.0) * all_calls));
}

/// The standard normal distribution.
double cumulative(double deviations) { return std::erfc(-deviations / std::numbers::sqrt2) / 2; }

/// The first and the last point suffice for calls that all take the same time.
void add_point(TimePoints& points, TimePoint point) {
  const std::size_t count = points.size();
  if (count > 0 && points.back() == point) return;
  if (count > 1 && points[count - 1].time == point.time && points[count - 2].time == point.time)
    points.back() = point;
  else
    points.push_back(point);
}

/// Between the two neighbouring ones of the sorted times.
Duration quantile(const std::vector<Duration>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(at), sorted.size() - 1);
  const std::size_t after = std::min(before + 1, sorted.size() - 1);
  const double width = ns_of(sorted[after] - sorted[before]);
  return sorted[before] + time_of(width * (at - static_cast<double>(before)));
}

}  // namespace

TimePoints normal_points(Duration mean, Duration deviation, Duration shortest, Duration longest) {
  const double reach = farthest_deviations * ns_of(deviation);
  const double from = std::max(ns_of(shortest), ns_of(mean) - reach);
  const double to = std::min(ns_of(longest), ns_of(mean) + reach);
  const auto below = [&](double time) { return cumulative((time - ns_of(mean)) / ns_of(deviation)); };
  const double first = below(from), all = below(to) - first;
  TimePoints points{{time_of(from), 0}};
  for (int part = 1; part < time_parts; ++part) {
    const double time = from + (to - from) * part / time_parts;
    add_point(points, {time_of(time), share_of_calls((below(time) - first) / all)});
  }
  add_point(points, {time_of(to), all_calls});
  return points;
}

TimePoints measured_points(std::vector<Duration> times) {
  std::ranges::sort(times);
  std::vector<double> shares;
  for (int part = 0; part <= time_parts; ++part) shares.push_back(static_cast<double>(part) / time_parts);
  for (double tail = 0.5 / time_parts; tail * static_cast<double>(times.size()) >= 1; tail /= 2)
    shares.insert(shares.end(), {tail, 1 - tail});
  std::ranges::sort(shares);
  TimePoints points;
  for (const double share : shares) add_point(points, {quantile(times, share), share_of_calls(share)});
  return points;
}

}  // namespace tessera::spec
