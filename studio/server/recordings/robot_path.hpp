#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::server {

/// A pose of the robot in the floor picture.
struct PathPoint {
  std::int64_t time_ns = 0;
  double x_m = 0, y_m = 0, heading_rad = 0;
};

/// Reads the path of a simulated robot (sim/trace.hpp) piece by piece. Lines that
/// are no points are skipped.
class PathReader {
 public:
  /// The points of all complete lines.
  [[nodiscard]] std::vector<PathPoint> feed(std::string_view bytes);

 private:
  std::string line_;
};

/// A path of any length in at most so many points, which are evenly spread.
class ThinnedPath {
 public:
  /// most: at least 3.
  explicit ThinnedPath(std::size_t most) : most_(most) {}
  void add(const PathPoint& point);
  /// [[t, x, y, heading]]. The last row is the point that was added last.
  [[nodiscard]] nlohmann::json rows() const;

 private:
  std::size_t most_, every_ = 1, count_ = 0;
  std::vector<PathPoint> points_;  // one of `every_`
  PathPoint last_;
};

}  // namespace tessera::server
