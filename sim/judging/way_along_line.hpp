#pragma once

#include <cstddef>
#include <vector>

#include "sim/track.hpp"

namespace tessera::sim {

/// The projection of a point onto the line.
struct LineFoot {
  double along_m = 0;
  double left_m = 0;  ///< signed distance, left of the line's direction positive
};

/// Follows a path along a line. At crossings, it stays on the branch that the path takes.
class WayAlongLine {
 public:
  /// line: has at least two points, and must outlive this object.
  explicit WayAlongLine(const Skeleton& line);

  /// The foot of the next point of the path. The progress since the last point is added to progress_m().
  LineFoot next(const Point& p);
  [[nodiscard]] double progress_m() const { return progress_; }
  [[nodiscard]] double length_m() const { return length_; }

 private:
  /// The difference from `b` to `a` along the shorter way.
  [[nodiscard]] double difference(double a, double b) const;
  [[nodiscard]] LineFoot nearest(const Point& p, double around_m, double within_m) const;
  [[nodiscard]] LineFoot foot_on(const Point& p, std::size_t i) const;

  const Skeleton& line_;
  std::vector<double> starts_;  ///< start of each segment, along the line
  double length_ = 0;
  double progress_ = 0;
  LineFoot foot_;
  Point last_;
  bool started_ = false;
};

}  // namespace tessera::sim
