#include "sim/judging/eyes.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::sim {
namespace {

constexpr double line_threshold = 0.5;

/// The point nearest to the mean of all: for three sensors in a row, the middle one.
Point middle_of(const std::vector<Point>& points) {
  Point mean;
  for (const Point& p : points) {
    mean.x_m += p.x_m / static_cast<double>(points.size());
    mean.y_m += p.y_m / static_cast<double>(points.size());
  }
  return *std::ranges::min_element(
      points, {}, [&](const Point& p) { return std::hypot(p.x_m - mean.x_m, p.y_m - mean.y_m); });
}

}  // namespace

std::size_t Eyes::add(Eye eye) {
  all_.push_back(eye);
  return all_.size() - 1;
}

double Eyes::light_under(const Physics& physics, std::size_t eye) const {
  const Eye& one = all_[eye];
  return floor_ ? floor_->reflectance(physics.site_position(one.site), one.footprint_m) : 1;
}

std::optional<Eyes::Look> Eyes::look(const Physics& physics, std::optional<Physics::RootBody> robot) const {
  std::vector<Point> positions;
  Look look;
  for (std::size_t eye = 0; eye < all_.size(); ++eye) {
    if (robot && physics.root_of_site(all_[eye].site) != *robot) continue;
    positions.push_back(physics.site_position(all_[eye].site));
    look.on_line = look.on_line || light_under(physics, eye) < line_threshold;
  }
  if (positions.empty()) return std::nullopt;
  look.middle = middle_of(positions);
  return look;
}

}  // namespace tessera::sim
