#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tessera/device.hpp"
#include "tessera/poses.hpp"

namespace tessera::sim {

/// The picture that lies on the floor, its lower left corner at the origin. width_m 0: none.
struct FloorPicture {
  double width_m = 0, height_m = 0;
  std::uint32_t width_px = 0, height_px = 0;
  std::span<const std::uint8_t> pixels;  ///< grey, row by row from the top
};

/// The bodies of a model that can move and are worth showing: those with visible geoms, and children of the
/// world. Indices of the model, in ascending order.
[[nodiscard]] std::vector<int> moving_bodies(const mjModel& model);

/// The name of a body; a body without a name gets one that no other body has ("body 7").
[[nodiscard]] std::string body_name(const mjModel& model, int body);

/// For each of `bodies` the agent whose devices it carries; empty: none, or several. A body that is named
/// "robot[3]/..." belongs to robot[3].
[[nodiscard]] std::vector<std::string> agents_of_bodies(const mjModel& model, std::span<const int> bodies,
                                                        std::span<const DriverRequest> devices);

/// The model as it was compiled (all joints at their reference), whatever its state is now. A glTF file with
/// a node per body; the node of the n-th of `bodies` has extras {"body": n}. It shows what the engine's own
/// viewer shows by default: geoms of the groups 0 to 2. It leaves out tendons, skins, sites, lights and
/// textures wrapped around bodies. Throws std::runtime_error.
[[nodiscard]] std::string glb_of(const mjModel& model, std::span<const int> bodies,
                                 const FloorPicture& floor);

/// located: with computed positions of the bodies.
void read_poses(const mjData& located, std::span<const int> bodies, std::vector<BodyPose>& poses);

}  // namespace tessera::sim
