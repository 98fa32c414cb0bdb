#include "sim/judging/way_along_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::sim {
namespace {

/// Farther away than this, the robot has left this part of the line and may return to any part.
constexpr double off_the_line_m = 0.1;

}  // namespace

WayAlongLine::WayAlongLine(const Skeleton& line) : line_(line) {
  const std::size_t segments = line.points.size() - (line.closed ? 0 : 1);
  for (std::size_t i = 0; i < segments; ++i) {
    starts_.push_back(length_);
    const Point& a = line.points[i];
    const Point& b = line.points[(i + 1) % line.points.size()];
    length_ += std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  }
}

LineFoot WayAlongLine::next(const Point& p) {
  const double moved = started_ ? std::hypot(p.x_m - last_.x_m, p.y_m - last_.y_m) : 0;
  last_ = p;
  if (started_) {
    const LineFoot near = nearest(p, foot_.along_m, std::min(0.03 + 2 * moved, off_the_line_m));
    if (std::abs(near.left_m) <= off_the_line_m) {
      progress_ += difference(near.along_m, foot_.along_m);
      return foot_ = near;
    }
  }
  started_ = true;
  return foot_ = nearest(p, 0, std::numeric_limits<double>::infinity());
}

double WayAlongLine::difference(double a, double b) const {
  const double d = a - b;
  return line_.closed ? d - length_ * std::round(d / length_) : d;
}

LineFoot WayAlongLine::nearest(const Point& p, double around_m, double within_m) const {
  LineFoot best;
  double least = std::numeric_limits<double>::infinity();
  const auto count = static_cast<std::ptrdiff_t>(starts_.size());
  auto first = static_cast<std::ptrdiff_t>(0);
  auto last = count;
  if (within_m < length_ / 2) {
    const double per_segment = length_ / static_cast<double>(count);
    const auto middle =
        static_cast<std::ptrdiff_t>(std::ranges::upper_bound(starts_, around_m) - starts_.begin()) - 1;
    const auto reach = static_cast<std::ptrdiff_t>(within_m / per_segment) + 2;
    first = line_.closed ? middle - reach : std::max(std::ptrdiff_t{0}, middle - reach);
    last = line_.closed ? middle + reach : std::min(count, middle + reach);
  }
  for (std::ptrdiff_t i = first; i < last; ++i) {
    const LineFoot foot = foot_on(p, static_cast<std::size_t>((i % count + count) % count));
    if (std::abs(foot.left_m) < least) {
      least = std::abs(foot.left_m);
      best = foot;
    }
  }
  return best;
}

LineFoot WayAlongLine::foot_on(const Point& p, std::size_t i) const {
  const Point& a = line_.points[i];
  const Point& b = line_.points[(i + 1) % line_.points.size()];
  const double dx = b.x_m - a.x_m;
  const double dy = b.y_m - a.y_m;
  const double length = std::hypot(dx, dy);
  if (length <= 0) return {starts_[i], std::hypot(p.x_m - a.x_m, p.y_m - a.y_m)};
  const double t = std::clamp(((p.x_m - a.x_m) * dx + (p.y_m - a.y_m) * dy) / (length * length), 0.0, 1.0);
  const double away = std::hypot(p.x_m - a.x_m - t * dx, p.y_m - a.y_m - t * dy);
  const double side = dx * (p.y_m - a.y_m) - dy * (p.x_m - a.x_m);
  return {starts_[i] + t * length, std::copysign(away, side)};
}

}  // namespace tessera::sim
