#pragma once

#include <span>
#include <vector>

#include "sim/engine/physics.hpp"
#include "sim/track.hpp"
#include "tessera/device.hpp"
#include "tessera/poses.hpp"
#include "tessera/time.hpp"

namespace tessera::sim {

/// Samples a world for display: its appearance, and the poses of its bodies at the first step at or after
/// every multiple of `pose_period`.
///
/// Threads: one at a time.
class PoseSampler {
 public:
  /// floor: nullptr: white. devices: of the run. Throws std::runtime_error.
  [[nodiscard]] static WorldScene scene(const Physics& physics, const Track* floor,
                                        std::span<const DriverRequest> devices);
  void show(PoseSink& sink) { sink_ = &sink; }
  /// Call it before every step.
  void look(const Physics& physics);

 private:
  PoseSink* sink_ = nullptr;
  std::vector<int> bodies_;
  std::vector<BodyPose> poses_;
  Duration next_{0};
};

}  // namespace tessera::sim
