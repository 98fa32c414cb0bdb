#include "sim/compose/layout.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include "sim/engine/complaint.hpp"
#include "sim/mjcf/model_file.hpp"
#include "tessera/nearest.hpp"

namespace tessera::sim {

Result<std::vector<Placement>> on_grid(const Grid& grid, std::vector<Placement> placements) {
  if (grid.columns == 0) return Problem{"a grid has one column at least"};
  if (!(grid.spacing_m > 0 && std::isfinite(grid.spacing_m)))
    return Problem{"the spacing of a grid must be positive"};
  if (!std::isfinite(grid.x_m) || !std::isfinite(grid.y_m) || !std::isfinite(grid.z_m))
    return Problem{"the corner of a grid must be finite"};
  for (std::size_t i = 0; i < placements.size(); ++i) {
    placements[i].x_m = grid.x_m + grid.spacing_m * static_cast<double>(i % grid.columns);
    placements[i].y_m = grid.y_m + grid.spacing_m * static_cast<double>(i / grid.columns);
    placements[i].z_m = grid.z_m;
  }
  return placements;
}

namespace {

using Point3 = std::array<mjtNum, 3>;

struct Volume {
  int type = mjGEOM_BOX;
  Point3 size{}, position{};
  std::array<mjtNum, 9> axes{};
};

/// Not std::uniform_real_distribution: its numbers differ from library to library.
double from_minus_one_to_one(std::mt19937_64& random) {
  return std::ldexp(static_cast<double>(random() >> 11), -52) - 1;
}

bool is_inside(const Volume& volume, const Point3& scaled) {
  const double across = scaled[0] * scaled[0] + scaled[1] * scaled[1];
  switch (volume.type) {
    case mjGEOM_CYLINDER:
      return across <= 1;
    case mjGEOM_CAPSULE: {  // scaled by its radius, and by half its length with the caps
      const double radius = volume.size[0], half = volume.size[1];
      const double beyond = std::max(0.0, std::abs(scaled[2]) * (half + radius) - half) / radius;
      return across + beyond * beyond <= 1;
    }
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
      return across + scaled[2] * scaled[2] <= 1;
    default:
      return true;
  }
}

/// Half the side lengths of its bounding box.
Point3 half_sides(const Volume& volume) {
  const Point3& size = volume.size;
  switch (volume.type) {
    case mjGEOM_SPHERE:
      return {size[0], size[0], size[0]};
    case mjGEOM_CYLINDER:
      return {size[0], size[0], size[1]};
    case mjGEOM_CAPSULE:
      return {size[0], size[0], size[0] + size[1]};
    default:
      return size;
  }
}

Point3 draw(const Volume& volume, std::mt19937_64& random) {
  Point3 scaled{}, inner{}, point{};
  do {
    for (mjtNum& number : scaled) number = from_minus_one_to_one(random);
  } while (!is_inside(volume, scaled));
  const Point3 half = half_sides(volume);
  for (std::size_t i = 0; i < 3; ++i) inner[i] = scaled[i] * half[i];
  mju_rotVecMat(point.data(), inner.data(), volume.axes.data());
  mju_addTo3(point.data(), volume.position.data());
  return point;
}

std::string no_site(const mjModel& model, const std::string& file, const std::string& site) {
  std::vector<std::string> names;
  std::string list;
  for (int id = 0; id < model.nsite && names.size() < 100; ++id) {
    const char* const named = mj_id2name(&model, mjOBJ_SITE, id);
    const std::string name = named != nullptr ? named : "";
    if (name.empty() || name.front() == '(') continue;
    names.push_back(name);
    list += (list.empty() ? "" : ", ") + name;
  }
  return with_hint(
      file + ": has no site '" + site + "'; " + (list.empty() ? "it has none" : "it has " + list),
      did_you_mean(site, names));
}

Result<Volume> volume_of(const std::string& world_file, const std::string& site) {
  const auto world = read_model_file(world_file);
  if (!world) return Problem{world.problem()};
  const mjModel& model = *(*world)->alone;
  const int id = mj_name2id(&model, mjOBJ_SITE, site.c_str());
  if (id < 0 || site.empty()) return Problem{no_site(model, world_file, site)};
  Volume volume{model.site_type[id], {}, {}, {}};
  std::copy_n(model.site_size + 3 * id, 3, volume.size.begin());
  DataPtr data;
  const std::optional<Problem> complaint = complaint_of([&] {
    data.reset(mj_makeData(&model));
    if (data) mj_kinematics(&model, data.get());
  });
  if (complaint) return Problem{world_file + ": " + complaint->text};
  if (!data) return Problem{world_file + ": there is no memory for its state"};
  std::copy_n(data->site_xpos + 3 * id, 3, volume.position.begin());
  std::copy_n(data->site_xmat + 9 * id, 9, volume.axes.begin());
  return volume;
}

bool is_free(const Point3& point, const std::vector<Point3>& taken, double apart_m) {
  return std::ranges::none_of(
      taken, [&](const Point3& other) { return mju_dist3(point.data(), other.data()) < apart_m; });
}

/// Draws positions as long as one may fit.
std::vector<Point3> draw_apart(const Volume& volume, std::size_t count, double apart_m, std::uint64_t seed) {
  constexpr int most_tries = 20'000;
  std::mt19937_64 random(seed);
  std::vector<Point3> taken;
  for (int tries = 0; taken.size() < count && tries < most_tries; ++tries) {
    const Point3 point = draw(volume, random);
    if (!is_free(point, taken, apart_m)) continue;
    taken.push_back(point);
    tries = 0;
  }
  return taken;
}

std::string metres(double value) {
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text + " m";
}

}  // namespace

Result<std::vector<Placement>> scatter(const std::string& world_file, const std::string& site, double apart_m,
                                       std::uint64_t seed, std::vector<Placement> placements) {
  if (!(apart_m >= 0 && std::isfinite(apart_m)))
    return Problem{"the distance between scattered things must be a number from 0 up"};
  const Result<Volume> volume = volume_of(world_file, site);
  if (!volume) return Problem{volume.problem()};
  const std::vector<Point3> points = draw_apart(*volume, placements.size(), apart_m, seed);
  if (points.size() < placements.size())
    return Problem{world_file + ": there is no room in site '" + site + "' for " +
                   std::to_string(placements.size()) + " things " + metres(apart_m) + " apart; " +
                   std::to_string(points.size()) + " found a place"};
  for (std::size_t i = 0; i < placements.size(); ++i) {
    placements[i].x_m += points[i][0];
    placements[i].y_m += points[i][1];
    placements[i].z_m += points[i][2];
  }
  return placements;
}

}  // namespace tessera::sim
