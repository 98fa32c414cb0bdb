#include "points.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tessera::checks_test {

std::vector<std::int64_t> Points::indices_of(std::string_view name) const {
  std::vector<std::int64_t> indices;
  for (const auto& [point, position] : at) {
    if (!point.starts_with(std::string(name) + "[") || !point.ends_with("]")) continue;
    std::int64_t index = 0;
    std::from_chars(point.data() + name.size() + 1, point.data() + point.size() - 1, index);
    indices.push_back(index);
  }
  std::ranges::sort(indices);
  return indices;
}

Result<std::size_t> Points::find(As /*as*/, const std::string& name) {
  if (!at.contains(name)) return Problem{"the world has no '" + name + "'"};
  names_.push_back(name);
  return names_.size() - 1;
}

std::size_t Points::dimension_of(std::size_t sensor) const { return names_[sensor] == "clock" ? 1 : 3; }
std::array<double, 3> Points::position(std::size_t point) { return at.at(names_[point]); }
double Points::speed(std::size_t point) { return speeds[names_[point]]; }
bool Points::touched(std::size_t solid, std::size_t other) {
  return touching.contains({names_[solid], names_[other]});
}
bool Points::touched_anything(std::size_t solid) {
  return std::ranges::any_of(touching, [&](const auto& pair) {
    return pair.first == names_[solid] || pair.second == names_[solid];
  });
}
bool Points::inside(std::size_t point, std::size_t zone) {
  const auto a = position(point), b = position(zone);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 1;
}
double Points::sensor(std::size_t sensor, std::size_t component) { return position(sensor)[component]; }

}  // namespace tessera::checks_test
