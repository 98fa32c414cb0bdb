#pragma once

#include <string>

namespace tessera::report {

struct Colour {
  double red = 0, green = 0, blue = 0;  ///< 0 .. 1
};

/// From calm to alarming: 0 dark blue .. 1 red. The lightness is monotone, so that the colour-blind
/// can tell the colours apart.
[[nodiscard]] Colour heat(double share);

/// "#rrggbb".
[[nodiscard]] std::string css(const Colour& colour);

}  // namespace tessera::report
