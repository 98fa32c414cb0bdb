#include "sim/track.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>

namespace tessera::sim {
Result<Track> Track::load(const std::string& png, double metres_per_pixel) {
  if (!std::isfinite(metres_per_pixel) || metres_per_pixel <= 0)
    return Problem{"metres per pixel must be a positive number"};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, png.c_str()) == 0) return Problem{png + ": " + image.message};
  if (std::uint64_t{image.width} * image.height > largest_picture_px) {
    png_image_free(&image);
    return Problem{png + ": larger than " + std::to_string(largest_picture_px / 1'000'000) +
                   " million pixels"};
  }
  image.format = PNG_FORMAT_GRAY;
  Track track;
  track.width_ = image.width;
  track.height_ = image.height;
  track.metres_per_pixel_ = metres_per_pixel;
  track.pixels_.resize(PNG_IMAGE_SIZE(image));
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&image, &white, track.pixels_.data(), 0, nullptr) == 0)
    return Problem{png + ": " + image.message};
  return track;
}

double Track::width_m() const { return width_ * metres_per_pixel_; }
double Track::height_m() const { return height_ * metres_per_pixel_; }

namespace {

/// A row of the picture as a function of x, constant over each pixel, white outside.
class Row {
 public:
  Row(std::span<const std::uint8_t> pixels, std::int64_t width, std::int64_t height, std::int64_t y) {
    if (y >= 0 && y < height)
      row_ = pixels.subspan(static_cast<std::size_t>(y * width), static_cast<std::size_t>(width));
  }
  /// The integral of the grey value from `from` to `to`, in pixels.
  [[nodiscard]] double integral(double from, double to) const {
    const auto first = static_cast<std::int64_t>(std::floor(from));
    const auto last = static_cast<std::int64_t>(std::floor(to));
    if (first == last) return grey(first) * (to - from);
    double sum =
        grey(first) * (static_cast<double>(first + 1) - from) + grey(last) * (to - static_cast<double>(last));
    for (std::int64_t x = first + 1; x < last; ++x) sum += grey(x);
    return sum;
  }

 private:
  [[nodiscard]] double grey(std::int64_t x) const {
    return x >= 0 && x < static_cast<std::int64_t>(row_.size()) ? row_[static_cast<std::size_t>(x)] : 255.0;
  }
  std::span<const std::uint8_t> row_;
};

}  // namespace

// The integral is exact along x. Along y, each row of pixels is cut into strips of equal height, and the
// chord of each strip is taken at mid-height.
double Track::reflectance(Point at, double footprint_m) const {
  const double x = at.x_m / metres_per_pixel_;
  const double y = height_ - at.y_m / metres_per_pixel_;  // rows count from the top
  const double radius = std::max(footprint_m / metres_per_pixel_ / 2, 1e-3);
  // Far outside, everything is white; the limit also keeps the conversions to integers in range.
  const double reach = radius + 1;
  if (!(x > -reach && y > -reach && x < width_ + reach && y < height_ + reach)) return 1;

  const auto first = static_cast<std::int64_t>(std::floor(y - radius));
  const auto last = static_cast<std::int64_t>(std::floor(y + radius));
  const auto strips = std::max<std::int64_t>(1, 16 / (last - first + 1));
  double light = 0;
  double area = 0;
  for (std::int64_t r = first; r <= last; ++r) {
    const Row row(pixels_, width_, height_, r);
    const double top = std::max(static_cast<double>(r), y - radius);
    const double height =
        (std::min(static_cast<double>(r + 1), y + radius) - top) / static_cast<double>(strips);
    for (std::int64_t s = 0; s < strips; ++s) {
      const double dy = top + (static_cast<double>(s) + 0.5) * height - y;
      const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
      light += height * row.integral(x - half, x + half);
      area += height * 2 * half;
    }
  }
  return area > 0 ? light / (area * 255) : 1;
}

}  // namespace tessera::sim
