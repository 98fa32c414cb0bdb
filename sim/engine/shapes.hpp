#pragma once

#include <mujoco/mujoco.h>

#include <array>

namespace tessera::sim {

/// Whether a point, in the axes of the world, lies in the volume of a site. data: with positions.
[[nodiscard]] bool is_inside_site(const mjModel& model, const mjData& data, int site, const mjtNum* point);

/// Whether a body is `ancestor` or hangs on it. The world's body stands for itself only: nothing hangs on it.
[[nodiscard]] bool is_part_of(const mjModel& model, int body, int ancestor);

}  // namespace tessera::sim
