#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tessera::report {

/// A colour picture with text on it.
struct Frame {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from the top
};

/// The text of a frame of a film.
struct Caption {
  std::string title;                ///< top left
  std::string time;                 ///< bottom left
  std::vector<std::string> alarms;  ///< below the title, in red; the first four are shown
};
void put_caption(Frame& frame, const Caption& caption);

/// PNG bytes, 8 bits a colour.
[[nodiscard]] std::string png_of(const Frame& frame);

}  // namespace tessera::report
