#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/result.hpp"

namespace tessera::sim {

/// The file of the track's picture; no png: there is none.
struct TrackFile {
  std::string png;
  double metres_per_pixel = 1;
};

/// The picture of the track as cameras see it: in colour, its lower left corner at the origin, as light
/// sensors read it (Track). Only pictures show it; it is no part of the physics, and no ray hits it.
class TrackPicture {
 public:
  /// Transparency becomes white. A picture of more than 4096 pixels a side is made smaller.
  [[nodiscard]] static Result<TrackPicture> load(const TrackFile& file);

  /// The object that lies on the floor. texture: its number among the textures of the renderer.
  [[nodiscard]] mjvGeom geom(int texture) const;

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Rows from the top.
  [[nodiscard]] const std::vector<std::uint8_t>& rgb() const { return rgb_; }

 private:
  int columns_ = 0, rows_ = 0;
  double width_m_ = 0, height_m_ = 0;
  std::vector<std::uint8_t> rgb_;
};

/// The textures of a model and, after them, that of a floor.
class TexturesWithTrack {
 public:
  TexturesWithTrack(const mjModel& model, const TrackPicture& floor);
  /// Makes the model use the arrays of this object.
  void lend_to(mjModel& model);

 private:
  std::vector<int> types_, heights_, widths_, addresses_;
  std::vector<mjtByte> rgb_;
};

}  // namespace tessera::sim
