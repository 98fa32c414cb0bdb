#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sorting_cell {

/// The picture of the camera above the belt: rows from the top, which is the far side of the belt.
inline constexpr std::size_t picture_width = 64, picture_height = 48;

struct Sight {
  bool occupied = false, red = false;
  double across_m = 0;  ///< from the middle of the belt
};

/// The box in the two columns in the middle: the colour that most coloured pixels have, and their mean row.
inline Sight middle_of_picture(std::span<const std::uint8_t> rgb) {
  constexpr double metres_per_pixel = 2 * 0.63 * 0.26795 / picture_height;  // 0.63 m above boxes, 30 deg
  constexpr std::size_t least = 10;                                         // pixels; a box has 14
  constexpr std::size_t far_edge = 12, near_edge = 36;  // of the belt; beyond it the arm carries boxes
  std::size_t red = 0, green = 0, rows = 0;
  for (std::size_t row = far_edge; row < near_edge; ++row)
    for (const std::size_t column : {picture_width / 2 - 1, picture_width / 2}) {
      const std::uint8_t* pixel = &rgb[3 * (row * picture_width + column)];
      const bool is_red = pixel[0] > 60 && pixel[0] > 2 * pixel[1];
      const bool is_green = pixel[1] > 60 && pixel[1] > 2 * pixel[0];
      red += is_red ? 1 : 0;
      green += is_green ? 1 : 0;
      rows += is_red || is_green ? row : 0;
    }
  const std::size_t pixels = red + green;
  if (pixels < least) return {};
  const double row = static_cast<double>(rows) / static_cast<double>(pixels);
  return {true, red > green, ((picture_height - 1) / 2.0 - row) * metres_per_pixel};
}

}  // namespace sorting_cell
