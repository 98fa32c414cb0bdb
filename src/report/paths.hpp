#pragma once

#include <optional>
#include <string>
#include <vector>

#include "replay/robots.hpp"
#include "sim/trace.hpp"
#include "sim/track.hpp"

namespace tessera::report {

/// The path of a robot, in at most 2,000 points.
struct RobotPath {
  std::string name;
  std::vector<replay::RobotPoint> points;
};

/// The paths of the robots, from the poses in the recording.
struct RunPaths {
  bool has_poses = false;
  std::vector<RobotPath> robots;
  /// If there is one robot: its path every 40 ms, and whether one of its light sensors was over the line.
  std::optional<sim::Trace> trace;
  std::string names() const;  ///< "rover, rover_2"
};

/// Reads the recording piece by piece. floor: for the light sensors; nullptr: there is no line.
[[nodiscard]] RunPaths paths_in(const std::string& recording, const sim::Track* floor);

}  // namespace tessera::report
