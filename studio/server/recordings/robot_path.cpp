#include "server/recordings/robot_path.hpp"

namespace tessera::server {

void ThinnedPath::add(const PathPoint& point) {
  last_ = point;
  if (count_++ % every_ != 0) return;
  points_.push_back(point);
  if (points_.size() < most_) return;
  // Removes every other point. There is room for one more, because of the last point.
  for (std::size_t index = 0; 2 * index < points_.size(); ++index) points_[index] = points_[2 * index];
  points_.resize((points_.size() + 1) / 2);
  every_ *= 2;
}

nlohmann::json ThinnedPath::rows() const {
  nlohmann::json rows = nlohmann::json::array();
  const auto add_row = [&](const PathPoint& point) {
    rows.push_back({point.time_ns, point.x_m, point.y_m, point.heading_rad});
  };
  for (const PathPoint& point : points_) add_row(point);
  if (count_ > 0 && (count_ - 1) % every_ != 0) add_row(last_);
  return rows;
}

}  // namespace tessera::server
