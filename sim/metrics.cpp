#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/track.hpp"

namespace tessera::sim {
namespace {

/// Farther away than this, the robot has left this part of the line and may come back anywhere.
constexpr double off_the_line_m = 0.1;

/// The projection of a point onto the line.
struct Foot {
  double along_m = 0;
  double left_m = 0;  ///< signed distance, left of the line's direction positive
};

/// Follows a path along a line, so that the right branch counts at crossings.
class Follow {
 public:
  explicit Follow(const Skeleton& line) : line_(line) {
    const std::size_t segments = line.points.size() - (line.closed ? 0 : 1);
    for (std::size_t i = 0; i < segments; ++i) {
      starts_.push_back(length_);
      const Point& a = line.points[i];
      const Point& b = line.points[(i + 1) % line.points.size()];
      length_ += std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    }
  }

  /// The foot of the next point of the path. The progress since the last point is added to progress_m().
  Foot next(const Point& p) {
    const double moved = started_ ? std::hypot(p.x_m - last_.x_m, p.y_m - last_.y_m) : 0;
    last_ = p;
    if (started_) {
      const Foot near = nearest(p, foot_.along_m, std::min(0.03 + 2 * moved, off_the_line_m));
      if (std::abs(near.left_m) <= off_the_line_m) {
        progress_ += difference(near.along_m, foot_.along_m);
        return foot_ = near;
      }
    }
    started_ = true;
    return foot_ = nearest(p, 0, std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] double progress_m() const { return progress_; }
  [[nodiscard]] double length_m() const { return length_; }

 private:
  /// The difference from `b` to `a` along the shorter way.
  [[nodiscard]] double difference(double a, double b) const {
    const double d = a - b;
    return line_.closed ? d - length_ * std::round(d / length_) : d;
  }

  [[nodiscard]] Foot nearest(const Point& p, double around_m, double within_m) const {
    Foot best;
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
      const Foot foot = foot_on(p, static_cast<std::size_t>((i % count + count) % count));
      if (std::abs(foot.left_m) < least) {
        least = std::abs(foot.left_m);
        best = foot;
      }
    }
    return best;
  }

  [[nodiscard]] Foot foot_on(const Point& p, std::size_t i) const {
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

  const Skeleton& line_;
  std::vector<double> starts_;  ///< of each segment, along the line
  double length_ = 0;
  double progress_ = 0;
  Foot foot_;
  Point last_;
  bool started_ = false;
};

void measure_losses(const Trace& trace, LineMetrics& metrics) {
  double loss = 0;
  for (std::size_t i = 0; i + 1 < trace.points.size(); ++i) {
    loss = trace.points[i].on_line ? 0 : loss + trace.points[i + 1].t_s - trace.points[i].t_s;
    if (!trace.points[i].on_line) metrics.line_lost_s += trace.points[i + 1].t_s - trace.points[i].t_s;
    metrics.longest_loss_s = std::max(metrics.longest_loss_s, loss);
  }
}

}  // namespace

LineMetrics measure(const Skeleton& line, const Trace& trace) {
  LineMetrics metrics;
  measure_losses(trace, metrics);
  if (line.points.size() < 2 || trace.points.empty()) return metrics;
  Follow follow(line);
  double sum = 0;
  for (const TracePoint& point : trace.points) {
    const Foot foot = follow.next({point.eye_x_m, point.eye_y_m});
    metrics.error_m.push_back(foot.left_m);
    sum += std::abs(foot.left_m);
    metrics.max_error_m = std::max(metrics.max_error_m, std::abs(foot.left_m));
  }
  metrics.mean_error_m = sum / static_cast<double>(trace.points.size());
  metrics.laps = std::abs(follow.progress_m()) / follow.length_m();
  if (follow.progress_m() < 0) {
    for (double& error : metrics.error_m) error = -error;
  }
  return metrics;
}

}  // namespace tessera::sim
