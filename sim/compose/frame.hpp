#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cmath>

#include "sim/compose/placement.hpp"

namespace tessera::sim {

/// A position and an orientation (quaternion w x y z).
struct Frame {
  std::array<mjtNum, 3> position{};
  std::array<mjtNum, 4> quaternion{1, 0, 0, 0};

  /// The frame of an object that is at `position`, `quaternion` in this frame.
  [[nodiscard]] Frame of(const mjtNum* at, const mjtNum* turned) const {
    Frame inner;
    mju_rotVecQuat(inner.position.data(), at, quaternion.data());
    mju_addTo3(inner.position.data(), position.data());
    mju_mulQuat(inner.quaternion.data(), quaternion.data(), turned);
    return inner;
  }
};

[[nodiscard]] inline Frame frame_of(const Placement& placement) {
  return {{placement.x_m, placement.y_m, placement.z_m},
          {std::cos(placement.heading_rad / 2), 0, 0, std::sin(placement.heading_rad / 2)}};
}

/// Whether a body moves on its own in the world: on a free joint, or as a mocap body. The engine allows both
/// only for children of the world.
[[nodiscard]] inline bool moves_freely(const mjModel& model, int body) {
  if (model.body_mocapid[body] >= 0) return true;
  return model.body_jntnum[body] > 0 && model.jnt_type[model.body_jntadr[body]] == mjJNT_FREE;
}

}  // namespace tessera::sim
