#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace tessera::sim {

/// What a world offers to drivers, as JSON (docs/worlds.md): sensors, joints, actuators, sites, cameras,
/// bodies, geoms, equalities and keyframes, each with the kinds of drivers and the types of buffers it fits.
[[nodiscard]] std::string contents_as_json(const mjModel& model);

}  // namespace tessera::sim
