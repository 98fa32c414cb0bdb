#include "drawing.hpp"

#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <stdexcept>

using tessera::sim::Point;

namespace {

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x_m - a.x_m;
  const double dy = b.y_m - a.y_m;
  const double squared = dx * dx + dy * dy;
  const double t =
      squared > 0 ? std::clamp(((p.x_m - a.x_m) * dx + (p.y_m - a.y_m) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(p.x_m - a.x_m - t * dx, p.y_m - a.y_m - t * dy);
}

std::size_t pixels(double metres, double metres_per_pixel) {
  return static_cast<std::size_t>(std::lround(metres / metres_per_pixel));
}

/// Darkens the pixels near one segment.
void draw(const Drawing& d, const Point& a, const Point& b, std::vector<std::uint8_t>& grey) {
  const auto width = static_cast<int>(pixels(d.width_m, d.metres_per_pixel));
  const auto height = static_cast<int>(pixels(d.height_m, d.metres_per_pixel));
  const double reach = d.line_width_m / 2 + d.metres_per_pixel;
  const auto column = [&](double x) { return static_cast<int>(std::floor(x / d.metres_per_pixel)); };
  for (int y = std::max(0, column(std::min(a.y_m, b.y_m) - reach));
       y <= std::min(height - 1, column(std::max(a.y_m, b.y_m) + reach)); ++y) {
    for (int x = std::max(0, column(std::min(a.x_m, b.x_m) - reach));
         x <= std::min(width - 1, column(std::max(a.x_m, b.x_m) + reach)); ++x) {
      const Point centre{(x + 0.5) * d.metres_per_pixel, (y + 0.5) * d.metres_per_pixel};
      const double outside =
          (distance_to_segment(centre, a, b) - d.line_width_m / 2) / d.metres_per_pixel + 0.5;
      auto& pixel = grey[static_cast<std::size_t>((height - 1 - y) * width + x)];
      pixel = std::min(pixel, static_cast<std::uint8_t>(std::lround(255 * std::clamp(outside, 0.0, 1.0))));
    }
  }
}

/// r = 1 + sum of a few waves, in polar coordinates.
std::vector<Point> wavy_circle(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::array<double, 7> size{}, phase{};
  for (std::size_t k = 2; k < size.size(); ++k) {
    size[k] = 0.5 * uniform(random) / static_cast<double>(k);
    phase[k] = 2 * std::numbers::pi * uniform(random);
  }
  std::vector<Point> points;
  constexpr int count = 1200;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    double r = 1;
    for (std::size_t k = 2; k < size.size(); ++k)
      r += size[k] * std::cos(static_cast<double>(k) * angle + phase[k]);
    points.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return points;
}

double smallest_radius(const std::vector<Point>& p) {
  double smallest = 1e9;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point& a = p[i];
    const Point& b = p[(i + 1) % p.size()];
    const Point& c = p[(i + 2) % p.size()];
    const double cross = (b.x_m - a.x_m) * (c.y_m - b.y_m) - (b.y_m - a.y_m) * (c.x_m - b.x_m);
    const double sides = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) * std::hypot(c.x_m - b.x_m, c.y_m - b.y_m) *
                         std::hypot(c.x_m - a.x_m, c.y_m - a.y_m);
    smallest = std::min(smallest, sides / (2 * std::abs(cross) + 1e-12));
  }
  return smallest;
}

}  // namespace

std::vector<std::uint8_t> rasterise(const Drawing& d) {
  std::vector<std::uint8_t> grey(
      pixels(d.width_m, d.metres_per_pixel) * pixels(d.height_m, d.metres_per_pixel), 255);
  for (const Stroke& stroke : d.strokes) {
    for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
      draw(d, stroke.points[i], stroke.points[i + 1], grey);
    if (stroke.closed) draw(d, stroke.points.back(), stroke.points.front(), grey);
  }
  return grey;
}

std::string write_png(const std::vector<std::uint8_t>& grey, std::size_t width_px, const std::string& name) {
  const std::string path =
      std::filesystem::temp_directory_path() / ("tessera_" + std::to_string(getpid()) + "_" + name + ".png");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(grey.size() / width_px);
  image.format = PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&image, path.c_str(), 0, grey.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  return path;
}

std::string write_png(const Drawing& drawing, const std::string& name) {
  return write_png(rasterise(drawing), pixels(drawing.width_m, drawing.metres_per_pixel), name);
}

Drawing random_loop(std::uint64_t seed, double smallest_radius_m) {
  auto points = wavy_circle(seed);
  const double scale = smallest_radius_m / smallest_radius(points);
  double left = 0, low = 0, right = 0, high = 0;
  for (Point& p : points) {
    p = {p.x_m * scale, p.y_m * scale};
    left = std::min(left, p.x_m), right = std::max(right, p.x_m);
    low = std::min(low, p.y_m), high = std::max(high, p.y_m);
  }
  constexpr double margin = 0.15;
  for (Point& p : points) p = {p.x_m - left + margin, p.y_m - low + margin};
  return {
      .width_m = right - left + 2 * margin, .height_m = high - low + 2 * margin, .strokes = {{points, true}}};
}

std::vector<Point> circle(double x_m, double y_m, double radius_m) {
  std::vector<Point> points;
  for (int i = 0; i < 200; ++i) {
    const double angle = 2 * std::numbers::pi * i / 200;
    points.push_back({x_m + radius_m * std::cos(angle), y_m + radius_m * std::sin(angle)});
  }
  return points;
}
