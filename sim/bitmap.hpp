#pragma once

#include <cstdint>
#include <vector>

#include "sim/track.hpp"

namespace tessera::sim {

/// The line of a floor picture in black and white. Rows begin at the bottom; the
/// border is one clear pixel wide.
struct Bitmap {
  int width = 0, height = 0;
  double pixel_m = 0;
  std::vector<std::uint8_t> line;  ///< 1 line, 0 floor

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  /// The middle of that pixel on the floor.
  [[nodiscard]] Point centre_of(std::size_t pixel) const;
};

/// Pixels darker than half become line. Pixels are at least 3 mm wide: a finer picture is averaged.
[[nodiscard]] Bitmap line_of(const Track& track);

/// Removes specks (dark spots less than 2 cm across) and fills holes in the line (bright
/// spots less than 2 cm across).
void clean(Bitmap& picture);

/// Thins the line to one pixel.
/// Source: Z. Guo, R. W. Hall, Parallel thinning with two-subiteration algorithms, CACM 32(3), 1989,
/// algorithm A1.
void thin(Bitmap& picture);

}  // namespace tessera::sim
