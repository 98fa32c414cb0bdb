#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace tessera::sim {

/// The elements of a world that drivers can use, as JSON (docs/use/worlds.md): sensors, joints, actuators, sites,
/// cameras, bodies, geoms, equalities and keyframes, each with the kinds of drivers and the types of buffers
/// it fits.
[[nodiscard]] std::string contents_as_json(const mjModel& model);

}  // namespace tessera::sim
