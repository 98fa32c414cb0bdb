#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "tessera/result.hpp"

namespace tessera::project {

/// A device of a simulated world whose values can be looked at: a scan as rays, a camera as a picture.
struct WorldView {
  std::string path;  ///< of the real buffer, "robot[0].laser.ranges"
  std::string type;  ///< of the buffer, "float64[32]"
  enum class Kind : std::uint8_t { scan, camera, depth, labels } kind = Kind::scan;
  std::string body;                               ///< that carries a scan; empty: it does not move
  std::array<double, 3> position_m{};             ///< of a scan on that body
  std::array<double, 4> quaternion{1, 0, 0, 0};   ///< w, x, y, z: x ahead, turned about z
  double from_rad = 0, to_rad = 0, reach_m = 10;  ///< of a scan
  int width = 0, height = 0;                      ///< of a picture
};

/// Those of the specification, in its order. Opens the world if there are scans.
/// project: the folder of the specification. Problem: the world cannot be opened.
[[nodiscard]] Result<std::vector<WorldView>> world_views(const spec::Model& model,
                                                         const std::filesystem::path& project);

}  // namespace tessera::project
