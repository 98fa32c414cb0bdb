#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "replay/robots.hpp"

namespace tessera::server {

/// A pose of the robot, seen from above.
using PathPoint = replay::RobotPoint;

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
