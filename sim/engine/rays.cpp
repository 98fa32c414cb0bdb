#include "sim/engine/rays.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::sim {
namespace {

/// The same rule as in the engine's own rays.
bool is_invisible(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  return model.geom_rgba[4 * geom + 3] == 0 && (material < 0 || model.mat_rgba[4 * material + 3] == 0);
}

mjtNum distance_along(const mjModel& model, const mjData& data, int geom, const mjtNum* from,
                      const mjtNum* direction) {
  switch (model.geom_type[geom]) {
    case mjGEOM_MESH:
      return mj_rayMesh(&model, &data, geom, from, direction);
    case mjGEOM_HFIELD:
      return mj_rayHfield(&model, &data, geom, from, direction);
    default:
      return mju_rayGeom(data.geom_xpos + 3 * geom, data.geom_xmat + 9 * geom, model.geom_size + 3 * geom,
                         from, direction, model.geom_type[geom]);
  }
}

/// A geom that a ray may hit, by the sphere around it.
struct Candidate {
  int geom;
  mjtNum centre[3];  ///< seen from the site, in the axes of the world
  mjtNum radius;     ///< 0: it is infinite, like a plane
};

}  // namespace

std::vector<int> geoms_around(const mjModel& model, int site, std::span<const int> left_out_groups) {
  const int root = model.body_rootid[model.site_bodyid[site]];
  std::vector<int> geoms;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const bool own = root != 0 && model.body_rootid[model.geom_bodyid[geom]] == root;
    const bool left_out = std::ranges::find(left_out_groups, model.geom_group[geom]) != left_out_groups.end();
    if (!own && !left_out && !is_invisible(model, geom)) geoms.push_back(geom);
  }
  return geoms;
}

void cast(const Physics& physics, const Fan& fan, std::span<double> distances_m) {
  const mjModel& model = physics.model();
  const mjData& now = physics.positions();
  const mjtNum* const from = now.site_xpos + 3 * fan.site;
  const mjtNum* const axes = now.site_xmat + 9 * fan.site;
  const mjtNum up[3] = {axes[2], axes[5], axes[8]};
  thread_local std::vector<Candidate> candidates;
  candidates.clear();
  for (const int geom : fan.geoms) {
    Candidate one{geom, {}, model.geom_rbound[geom]};
    mju_sub3(one.centre, now.geom_xpos + 3 * geom, from);
    if (one.radius > 0 &&
        (std::abs(mju_dot3(one.centre, up)) > one.radius || mju_norm3(one.centre) - one.radius > fan.reach_m))
      continue;
    candidates.push_back(one);
  }
  for (std::size_t ray = 0; ray < fan.angles_rad.size(); ++ray) {
    const mjtNum c = std::cos(fan.angles_rad[ray]), s = std::sin(fan.angles_rad[ray]);
    const mjtNum direction[3] = {axes[0] * c + axes[1] * s, axes[3] * c + axes[4] * s,
                                 axes[6] * c + axes[7] * s};
    mjtNum nearest = fan.reach_m;
    for (const Candidate& one : candidates) {
      if (one.radius > 0) {
        const mjtNum ahead = mju_dot3(one.centre, direction);
        const mjtNum aside_2 = mju_dot3(one.centre, one.centre) - ahead * ahead;
        constexpr mjtNum rounding = 1e-9;
        if (aside_2 > one.radius * one.radius + rounding || ahead + one.radius < 0 ||
            ahead - one.radius > nearest)
          continue;
      }
      const mjtNum distance = distance_along(model, now, one.geom, from, direction);
      if (distance >= 0 && distance < nearest) nearest = distance;
    }
    distances_m[ray] = nearest;
  }
}

}  // namespace tessera::sim
