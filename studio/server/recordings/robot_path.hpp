#pragma once

#include <nlohmann/json.hpp>

#include "replay/robots.hpp"

namespace tessera::server {

/// A pose of the robot, seen from above.
using PathPoint = replay::RobotPoint;

/// [[t, x, y, heading]...]
[[nodiscard]] nlohmann::json rows_of(const replay::Thinned<PathPoint>& path);

}  // namespace tessera::server
