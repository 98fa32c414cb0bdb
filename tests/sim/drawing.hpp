#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/track.hpp"

/// A line to draw on a floor picture.
struct Stroke {
  std::vector<tessera::sim::Point> points;
  bool closed = false;
};

struct Drawing {
  double width_m = 1, height_m = 1;
  double line_width_m = 0.05;
  double metres_per_pixel = 0.005;
  std::vector<Stroke> strokes;
};

/// Grey values row by row from the top: 0 on the lines, 255 beside them, between at their edges.
std::vector<std::uint8_t> rasterise(const Drawing& drawing);

/// Writes a grey PNG into the temporary directory; returns its path. Throws std::runtime_error.
std::string write_png(const std::vector<std::uint8_t>& grey, std::size_t width_px, const std::string& name);
std::string write_png(const Drawing& drawing, const std::string& name);

/// A smooth closed curve around the middle of a floor that fits it, whose sharpest bend has that radius.
Drawing random_loop(std::uint64_t seed, double smallest_radius_m);

/// Points of a circle.
std::vector<tessera::sim::Point> circle(double x_m, double y_m, double radius_m);
