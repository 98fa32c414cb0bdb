#pragma once

#include "drawing/geometry.hpp"
#include "drawing/picture.hpp"

namespace tessera::drawing {

/// Sizes of the symbols and of the texts to their right, in pixels.
struct Sizes {
  static constexpr double circle_radius = 12, page_radius = 15, bar_width = 32, bar_height = 5;
  static constexpr double cell = 34;  ///< width of a symbol's cell
  static constexpr double gap = 4;    ///< between symbol and text
  static constexpr double name_font = 12, detail_font = 10, frame_font = 12, line = 13;
};

/// The positions of all elements. Vectors are parallel to those of the picture.
struct Layout {
  double width = 0, height = 0;
  std::vector<Point> circles, bars;  ///< centres of the symbols
  std::vector<Curve> arrows;  ///< from the edge of one symbol to that of the other, in the arrow's direction
  std::vector<Box> frames;
};

/// Throws LayoutError.
[[nodiscard]] Layout lay_out(const Picture& picture);

}  // namespace tessera::drawing
