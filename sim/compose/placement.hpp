#pragma once

#include <optional>
#include <string>

namespace tessera::sim {

/// One model file put into a world once.
struct Placement {
  std::string name;   ///< such as "robot[3]": its elements are named "robot[3]/element"
  std::string model;  ///< MJCF file
  /// Where the origin of the model stands, and the turn about the vertical axis.
  double x_m = 0, y_m = 0, z_m = 0, heading_rad = 0;
  std::optional<std::string> keyframe;  ///< of the model file; nothing: the pose that the file draws
};

}  // namespace tessera::sim
