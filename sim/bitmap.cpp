#include "sim/bitmap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::sim {
namespace {

constexpr double finest_pixel_m = 0.003;
constexpr double speck_m = 0.02;

/// Mean grey value of a block of pixels, which may extend beyond the picture's edge.
double mean_grey(const Track& track, std::uint32_t x, std::uint32_t y, std::uint32_t block) {
  double sum = 0;
  std::uint32_t count = 0;
  for (std::uint32_t row = y; row < std::min(y + block, track.height_px()); ++row) {
    for (std::uint32_t column = x; column < std::min(x + block, track.width_px()); ++column, ++count) {
      sum += track.pixels()[std::size_t{row} * track.width_px() + column];
    }
  }
  return sum / count;
}

/// Marks and returns the pixels of the same kind that are connected to `seed` (over edges for floor, also
/// over corners for line).
std::vector<std::size_t> region(const Bitmap& picture, std::size_t seed, std::vector<std::uint8_t>& marked) {
  const auto w = static_cast<std::ptrdiff_t>(picture.width);
  const std::array<std::ptrdiff_t, 8> around = {1, -1, w, -w, w + 1, w - 1, -w + 1, -w - 1};
  const std::size_t neighbours = picture.line[seed] != 0 ? 8 : 4;
  std::vector<std::size_t> pixels{seed};
  marked[seed] = 1;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t n = 0; n < neighbours; ++n) {
      const auto next = pixels[i] + static_cast<std::size_t>(around[n]);
      if (next >= picture.line.size() || marked[next] != 0 || picture.line[next] != picture.line[seed])
        continue;
      marked[next] = 1;
      pixels.push_back(next);
    }
  }
  return pixels;
}

bool is_small(const Bitmap& picture, const std::vector<std::size_t>& pixels) {
  const auto width = static_cast<std::size_t>(picture.width);
  const auto [low, high] = std::ranges::minmax(pixels);
  const auto [left, right] = std::ranges::minmax(pixels, {}, [&](std::size_t p) { return p % width; });
  const double across =
      static_cast<double>(std::max(high / width - low / width, right % width - left % width) + 1);
  return across * picture.pixel_m < speck_m;
}

/// The eight neighbours of a pixel, clockwise from above, as p[0]..p[7].
std::array<int, 8> neighbours_of(const Bitmap& b, std::size_t pixel) {
  const auto w = static_cast<std::size_t>(b.width);
  const auto& l = b.line;
  return {l[pixel + w], l[pixel + w + 1], l[pixel + 1], l[pixel - w + 1],
          l[pixel - w], l[pixel - w - 1], l[pixel - 1], l[pixel + w - 1]};
}

bool may_go(const Bitmap& picture, std::size_t pixel, bool odd) {
  const auto p = neighbours_of(picture, pixel);
  const int crossings = (p[0] == 0 && (p[1] | p[2]) != 0) + (p[2] == 0 && (p[3] | p[4]) != 0) +
                        (p[4] == 0 && (p[5] | p[6]) != 0) + (p[6] == 0 && (p[7] | p[0]) != 0);
  if (crossings != 1) return false;
  const int one = (p[7] | p[0]) + (p[1] | p[2]) + (p[3] | p[4]) + (p[5] | p[6]);
  const int other = (p[0] | p[1]) + (p[2] | p[3]) + (p[4] | p[5]) + (p[6] | p[7]);
  const int fewer = std::min(one, other);
  if (fewer < 2 || fewer > 3) return false;
  return odd ? ((p[0] | p[1] | (1 - p[3])) & p[2]) == 0 : ((p[4] | p[5] | (1 - p[7])) & p[6]) == 0;
}

}  // namespace

Point Bitmap::centre_of(std::size_t pixel) const {
  const auto row = static_cast<std::size_t>(width);
  return {(static_cast<double>(pixel % row) - 0.5) * pixel_m,
          (static_cast<double>(pixel / row) - 0.5) * pixel_m};
}

Bitmap line_of(const Track& track) {
  const double per_pixel = track.metres_per_pixel();
  const auto block =
      static_cast<std::uint32_t>(std::max(1.0, std::round(std::min(finest_pixel_m / per_pixel, 1e4))));
  const std::uint32_t columns = (track.width_px() + block - 1) / block;
  const std::uint32_t rows = (track.height_px() + block - 1) / block;
  Bitmap picture{.width = static_cast<int>(columns + 2),
                 .height = static_cast<int>(rows + 2),
                 .pixel_m = per_pixel * block,
                 .line = {}};
  picture.line.resize(std::size_t{columns + 2} * (rows + 2));
  // Blocks start at the lower left corner, the origin of the floor; blocks at the top and right may be cut.
  for (std::uint32_t y = 0; y < rows; ++y) {
    const std::uint32_t top = track.height_px() - std::min(track.height_px(), (y + 1) * block);
    for (std::uint32_t x = 0; x < columns; ++x) {
      const bool dark = mean_grey(track, x * block, top, block) < 128;
      picture.line[picture.index(static_cast<int>(x) + 1, static_cast<int>(y) + 1)] = dark ? 1 : 0;
    }
  }
  return picture;
}

void clean(Bitmap& picture) {
  std::vector<std::uint8_t> marked(picture.line.size());
  std::vector<std::size_t> specks;
  for (std::size_t seed = 0; seed < picture.line.size(); ++seed) {
    if (marked[seed] != 0) continue;
    const auto pixels = region(picture, seed, marked);
    const bool outside = seed == 0;  // its border must stay clear, however small the picture is
    if (!outside && is_small(picture, pixels)) specks.insert(specks.end(), pixels.begin(), pixels.end());
  }
  for (const std::size_t pixel : specks) picture.line[pixel] ^= 1;
}

void thin(Bitmap& picture) {
  std::vector<std::size_t> left;
  for (std::size_t p = 0; p < picture.line.size(); ++p) {
    if (picture.line[p] != 0) left.push_back(p);
  }
  std::vector<std::size_t> going;
  int unchanged = 0;
  for (bool odd = true; unchanged < 2; odd = !odd) {
    going.clear();
    std::ranges::copy_if(left, std::back_inserter(going),
                         [&](std::size_t p) { return may_go(picture, p, odd); });
    for (const std::size_t p : going) picture.line[p] = 0;
    std::erase_if(left, [&](std::size_t p) { return picture.line[p] == 0; });
    unchanged = going.empty() ? unchanged + 1 : 0;
  }
}

}  // namespace tessera::sim
