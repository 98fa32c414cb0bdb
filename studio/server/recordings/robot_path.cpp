#include "server/recordings/robot_path.hpp"

namespace tessera::server {

nlohmann::json rows_of(const replay::Thinned<PathPoint>& path) {
  nlohmann::json rows = nlohmann::json::array();
  for (const PathPoint& point : path.points())
    rows.push_back({point.time_ns, point.x_m, point.y_m, point.heading_rad});
  return rows;
}

}  // namespace tessera::server
