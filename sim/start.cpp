#include <cmath>

#include "sim/track.hpp"

namespace tessera::sim {

namespace {

constexpr double stretch_m = 0.4;  // length of a robot and of the stretch that it sees ahead

/// The point one stretch further along the line; nullopt past the end of an open one.
std::optional<std::size_t> stretch_from(const Skeleton& line, std::size_t first) {
  double way = 0;
  std::size_t at = first;
  for (std::size_t step = 0; step < line.points.size() && way < stretch_m; ++step) {
    const std::size_t next = at + 1;
    if (next == line.points.size() && !line.closed) return std::nullopt;
    way += distance(line.points[at], line.points[next % line.points.size()]);
    at = next % line.points.size();
  }
  return at;
}

}  // namespace

std::optional<Pose> start_on(const Skeleton& line) {
  std::optional<Pose> best;
  double best_chord = 0;
  for (std::size_t first = 0; first < line.points.size(); ++first) {
    const std::optional<std::size_t> last = stretch_from(line, first);
    if (!last) break;
    const Point from = line.points[first], to = line.points[*last];
    // Among parts of equal length, the straightest has the longest chord.
    const double chord = distance(from, to);
    if (chord <= best_chord) continue;
    best_chord = chord;
    best = Pose{from, std::atan2(to.y_m - from.y_m, to.x_m - from.x_m)};
  }
  return best;
}

}  // namespace tessera::sim
