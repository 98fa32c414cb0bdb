#include "server/recordings/robot_path.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tessera::server {

namespace {

constexpr std::size_t longest_line = 1024;
constexpr double longest_time_s = 9e9;  // the limit of nanoseconds

std::optional<PathPoint> point_of(std::string_view line) {
  std::array<double, 4> numbers{};
  for (double& number : numbers) {
    const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (problem != std::errc{} || end == line.data() + line.size() || !std::isfinite(number))
      return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  }
  if (std::abs(numbers[0]) > longest_time_s) return std::nullopt;
  return PathPoint{static_cast<std::int64_t>(numbers[0] * 1e9), numbers[1], numbers[2], numbers[3]};
}

}  // namespace

std::vector<PathPoint> PathReader::feed(std::string_view bytes) {
  std::vector<PathPoint> points;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    line_ += bytes.substr(0, std::min(end, longest_line - line_.size()));
    if (end == bytes.size()) break;
    if (const std::optional<PathPoint> point = point_of(line_)) points.push_back(*point);
    line_.clear();
    bytes.remove_prefix(end + 1);
  }
  return points;
}

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
