#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/trace.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// A point of the floor in metres: x right, y up, origin at the lower left corner of the picture.
struct Point {
  double x_m = 0, y_m = 0;
};
[[nodiscard]] inline double distance(const Point& a, const Point& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// A floor picture: dark is line. The floor outside it is white.
class Track {
 public:
  static constexpr std::uint64_t largest_picture_px = 100'000'000;

  /// Reads any PNG that libpng supports; colours become grey, transparency white.
  [[nodiscard]] static Result<Track> load(const std::string& png, double metres_per_pixel);

  /// Mean reflectance (0 dark .. 1 bright) of the disc with that diameter around `at`.
  [[nodiscard]] double reflectance(Point at, double footprint_m) const;

  [[nodiscard]] double width_m() const;
  [[nodiscard]] double height_m() const;
  [[nodiscard]] std::uint32_t width_px() const { return width_; }
  [[nodiscard]] std::uint32_t height_px() const { return height_; }
  [[nodiscard]] double metres_per_pixel() const { return metres_per_pixel_; }
  /// Grey values, row by row from the top, 0 dark .. 255 bright.
  [[nodiscard]] std::span<const std::uint8_t> pixels() const { return pixels_; }

 private:
  std::uint32_t width_ = 0, height_ = 0;
  double metres_per_pixel_ = 1;
  std::vector<std::uint8_t> pixels_;
};

/// The middle of the line as a polyline in driving order: the longest loop of the picture's skeleton, with
/// gaps bridged.
struct Skeleton {
  std::vector<Point> points;
  bool closed = false;
  [[nodiscard]] double length_m() const;
};
[[nodiscard]] Skeleton skeleton(const Track& track);

/// A start pose for a robot that follows the line: on its straightest part, facing along it. nullopt: there
/// is no line, or it is shorter than a robot.
struct Pose {
  Point at;
  double heading_rad = 0;
};
[[nodiscard]] std::optional<Pose> start_on(const Skeleton& line);

/// How well a path followed the line.
struct LineMetrics {
  double laps = 0;  ///< full progress along the skeleton: distance along it / its length, either direction
  double line_lost_s = 0;  ///< total time with no sensor over the line
  double longest_loss_s = 0;
  double mean_error_m = 0, max_error_m = 0;  ///< middle sensor to skeleton
  std::vector<double> error_m;  ///< signed (left of the driving direction positive), one per trace point
};
[[nodiscard]] LineMetrics measure(const Skeleton& line, const Trace& trace);

}  // namespace tessera::sim
