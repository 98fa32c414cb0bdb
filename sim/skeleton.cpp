#include <algorithm>
#include <cmath>

#include "sim/bitmap.hpp"
#include "sim/line_graph.hpp"
#include "sim/track.hpp"

namespace tessera::sim {
namespace {

constexpr double spacing_m = 0.005;
constexpr double smoothing_m = 0.008;  ///< standard deviation along the line
constexpr double shortest_line_m = 0.05;

/// Points every 5 mm or a little less; a closed line does not repeat its first.
Skeleton resample(Skeleton line) {
  if (line.closed) line.points.push_back(line.points.front());
  const double length = length_of(line.points);
  const auto count = static_cast<std::size_t>(std::ceil(length / spacing_m));
  Skeleton even{.points = {}, .closed = line.closed};
  double before = 0;  // where the segment i starts
  std::size_t i = 0;
  for (std::size_t k = 0; k < count + (line.closed ? 0 : 1); ++k) {
    const double at = length * static_cast<double>(k) / static_cast<double>(count);
    const auto segment = [&] {
      return std::hypot(line.points[i + 1].x_m - line.points[i].x_m,
                        line.points[i + 1].y_m - line.points[i].y_m);
    };
    while (i + 2 < line.points.size() && before + segment() < at) before += segment(), ++i;
    const double t = segment() > 0 ? std::clamp((at - before) / segment(), 0.0, 1.0) : 0;
    even.points.push_back({std::lerp(line.points[i].x_m, line.points[i + 1].x_m, t),
                           std::lerp(line.points[i].y_m, line.points[i + 1].y_m, t)});
  }
  return even;
}

/// Smooths along the line (Gaussian). An open line keeps its ends: it is continued point-symmetrically there.
Skeleton smooth(const Skeleton& line) {
  const auto count = static_cast<std::ptrdiff_t>(line.points.size());
  const auto at = [&](std::ptrdiff_t i) -> Point {
    if (line.closed) return line.points[static_cast<std::size_t>((i % count + count) % count)];
    const std::ptrdiff_t end = i < 0 ? 0 : count - 1;
    if (i >= 0 && i < count) return line.points[static_cast<std::size_t>(i)];
    const Point& mirror = line.points[static_cast<std::size_t>(end)];
    const Point& inside =
        line.points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(2 * end - i, 0, count - 1))];
    return {2 * mirror.x_m - inside.x_m, 2 * mirror.y_m - inside.y_m};
  };
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3 * smoothing_m / spacing_m));
  Skeleton result{.points = {}, .closed = line.closed};
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Point sum;
    double weights = 0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const double away = static_cast<double>(k) * spacing_m / smoothing_m;
      const double weight = std::exp(-away * away / 2);
      sum.x_m += weight * at(i + k).x_m;
      sum.y_m += weight * at(i + k).y_m;
      weights += weight;
    }
    result.points.push_back({sum.x_m / weights, sum.y_m / weights});
  }
  return result;
}

}  // namespace

double Skeleton::length_m() const {
  if (points.empty()) return 0;
  const double last =
      closed ? std::hypot(points.back().x_m - points.front().x_m, points.back().y_m - points.front().y_m) : 0;
  return length_of(points) + last;
}

Skeleton skeleton(const Track& track) {
  Bitmap picture = line_of(track);
  clean(picture);
  const auto dark = std::ranges::count(picture.line, 1);
  thin(picture);
  const auto thinned = std::ranges::count(picture.line, 1);
  if (thinned == 0) return {};
  const double width_m = static_cast<double>(dark) / static_cast<double>(thinned) * picture.pixel_m;
  LineGraph graph(picture, width_m);
  graph.simplify();
  graph.bridge_gaps();
  graph.keep_loops();
  const Skeleton raw = graph.longest_way();
  if (raw.length_m() < shortest_line_m) return {};
  return smooth(resample(raw));
}

}  // namespace tessera::sim
