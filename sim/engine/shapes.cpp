#include "sim/engine/shapes.hpp"

#include <cmath>

namespace tessera::sim {

bool is_inside_site(const mjModel& model, const mjData& data, int site, const mjtNum* point) {
  mjtNum apart[3], p[3];
  mju_sub3(apart, point, data.site_xpos + 3 * site);
  mju_rotVecMatT(p, apart, data.site_xmat + 9 * site);
  const mjtNum* const size = model.site_size + 3 * site;
  switch (model.site_type[site]) {
    case mjGEOM_SPHERE:
      return std::hypot(p[0], p[1], p[2]) <= size[0];
    case mjGEOM_CAPSULE:
      return std::hypot(p[0], p[1], p[2] - mju_clip(p[2], -size[1], size[1])) <= size[0];
    case mjGEOM_CYLINDER:
      return std::hypot(p[0], p[1]) <= size[0] && std::abs(p[2]) <= size[1];
    case mjGEOM_ELLIPSOID:
      return std::hypot(p[0] / size[0], p[1] / size[1], p[2] / size[2]) <= 1;
    default:
      return std::abs(p[0]) <= size[0] && std::abs(p[1]) <= size[1] && std::abs(p[2]) <= size[2];
  }
}

bool is_part_of(const mjModel& model, int body, int ancestor) {
  if (ancestor == 0) return body == 0;
  while (body != 0 && body != ancestor) body = model.body_parentid[body];
  return body == ancestor;
}

}  // namespace tessera::sim
