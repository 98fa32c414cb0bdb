#pragma once

#include <mujoco/mujoco.h>

#include <array>

namespace tessera::sim {

/// Whether a point, in the axes of the world, lies in the volume of a site. data: with computed positions.
[[nodiscard]] bool is_inside_site(const mjModel& model, const mjData& data, int site, const mjtNum* point);

/// Whether a body is `ancestor` or attached to it. For the world's body, only that body itself counts.
[[nodiscard]] bool is_part_of(const mjModel& model, int body, int ancestor);

}  // namespace tessera::sim
