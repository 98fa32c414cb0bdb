#pragma once

#include <optional>
#include <string>

namespace tessera::sim {

/// One placement of a model file in a world.
struct Placement {
  std::string name;   ///< such as "robot[3]": its elements are named "robot[3]/element"
  std::string model;  ///< MJCF file
  /// The position of the model's origin, and the turn about the vertical axis.
  double x_m = 0, y_m = 0, z_m = 0, heading_rad = 0;
  std::optional<std::string> keyframe;  ///< of the model file; nullopt: the pose of the file
};

}  // namespace tessera::sim
