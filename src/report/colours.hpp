#pragma once

#include <string>

namespace tessera::report {

struct Colour {
  double red = 0, green = 0, blue = 0;  ///< 0 .. 1
};

/// From calm to alarming: 0 dark blue .. 1 red. Monotone in lightness, and told apart by the colour-blind.
[[nodiscard]] Colour heat_colour(double share);

/// "#rrggbb".
[[nodiscard]] std::string css_colour(const Colour& colour);

}  // namespace tessera::report
