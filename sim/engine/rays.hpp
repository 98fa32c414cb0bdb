#pragma once

#include <span>
#include <vector>

#include "sim/engine/physics.hpp"

namespace tessera::sim {

/// Rays from a site in the plane of its x and y axes.
struct Fan {
  int site = 0;
  std::vector<double> angles_rad;  ///< from the x axis towards the y axis
  double reach_m = 10;
  std::vector<int> geoms;  ///< the geoms that rays can hit
};

/// The geoms that rays from a site can hit. Excluded are those of the site's own robot (its root body with
/// everything attached to it), invisible ones, and those of the groups.
[[nodiscard]] std::vector<int> geoms_around(const mjModel& model, int site,
                                            std::span<const int> left_out_groups);

/// The distance to the first geom on each ray; `reach_m` if there is none up to that distance.
void cast(const Physics& physics, const Fan& fan, std::span<double> distances_m);

}  // namespace tessera::sim
