#include "cli/path_plot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera::cli {

namespace {

constexpr int columns = 60, most_rows = 24;

/// A canvas of dots, two by four in each character.
class Dots {
 public:
  Dots(int width, int height)
      : width_(width), height_(height), cells_(static_cast<std::size_t>(width) * height) {}

  /// x to the right, y down, in dots.
  void set(int x, int y) {
    static constexpr unsigned char bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    if (x < 0 || y < 0 || x >= width_ * 2 || y >= height_ * 4) return;
    cells_[static_cast<std::size_t>(y / 4) * width_ + x / 2] |= bits[y % 4][x % 2];
  }

  [[nodiscard]] std::string text() const {
    std::string text;
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column)
        text += braille(cells_[static_cast<std::size_t>(row) * width_ + column]);
      text += '\n';
    }
    return text;
  }

 private:
  // UTF-8 of U+2800 + dots.
  static std::string braille(unsigned char dots) {
    return {static_cast<char>(0xe2), static_cast<char>(0xa0 | (dots >> 6)),
            static_cast<char>(0x80 | (dots & 0x3f))};
  }
  int width_, height_;
  std::vector<unsigned char> cells_;
};

}  // namespace

std::string path_plot(const sim::Track& floor, const sim::Trace& trace) {
  // Dots per metre.
  const double scale = std::min(columns * 2 / floor.width_m(), most_rows * 4 / floor.height_m());
  Dots dots(static_cast<int>(std::ceil(floor.width_m() * scale / 2)),
            static_cast<int>(std::ceil(floor.height_m() * scale / 4)));
  for (const sim::TracePoint& point : trace.points)
    dots.set(static_cast<int>(point.x_m * scale), static_cast<int>((floor.height_m() - point.y_m) * scale));
  return dots.text();
}

}  // namespace tessera::cli
