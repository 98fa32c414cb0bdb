// Draws the tracks of share/tessera/tracks: draw_tracks DIRECTORY. The lines are black, anti-aliased
// and 0.05 m wide on white, at 5 mm per pixel. Grey levels give the position of edges more
// exactly than whole pixels.
#include <cairo.h>
#include <png.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double metres_per_pixel = 0.005;
constexpr double line_width_m = 0.05;

/// Draws like a robot that drives forward and along arcs, with the pen down or up.
class Pen {
 public:
  Pen(double width_m, double height_m, double x_m, double y_m)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, pixels(width_m), pixels(height_m))),
        picture_(cairo_create(surface_)),
        x_(x_m),
        y_(y_m) {
    cairo_translate(picture_, 0, pixels(height_m));
    cairo_scale(picture_, 1 / metres_per_pixel, -1 / metres_per_pixel);
    cairo_set_line_width(picture_, line_width_m);
    cairo_set_line_cap(picture_, CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(picture_, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(picture_, 0.02);
    cairo_move_to(picture_, x_, y_);
  }
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;
  ~Pen() {
    cairo_destroy(picture_);
    cairo_surface_destroy(surface_);
  }

  Pen& forward(double metres) {
    go(metres);
    cairo_line_to(picture_, x_, y_);
    return *this;
  }
  Pen& gap(double metres) {
    go(metres);
    cairo_move_to(picture_, x_, y_);
    return *this;
  }
  Pen& gap_left(double metres, double radius_m) {
    turn_about(metres / radius_m, radius_m, 1);
    cairo_move_to(picture_, x_, y_);
    return *this;
  }
  Pen& left(double degrees, double radius_m) { return arc(degrees, radius_m, 1); }
  Pen& right(double degrees, double radius_m) { return arc(degrees, radius_m, -1); }
  /// Joins the end to the start of the last stroke.
  Pen& close() {
    cairo_close_path(picture_);
    return *this;
  }

  bool write(const std::string& file) {
    cairo_stroke(picture_);
    cairo_surface_flush(surface_);
    const auto width = static_cast<std::size_t>(cairo_image_surface_get_width(surface_));
    const auto height = static_cast<std::size_t>(cairo_image_surface_get_height(surface_));
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface_));
    std::vector<std::uint8_t> grey;
    grey.reserve(width * height);
    for (std::size_t row = 0; row < height; ++row) {
      const unsigned char* ink = cairo_image_surface_get_data(surface_) + row * stride;
      for (std::size_t x = 0; x < width; ++x) grey.push_back(static_cast<std::uint8_t>(255 - ink[x]));
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_GRAY;
    if (png_image_write_to_file(&image, file.c_str(), 0, grey.data(), 0, nullptr) != 0) return true;
    std::fprintf(stderr, "%s: %s\n", file.c_str(), image.message);
    return false;
  }

 private:
  static int pixels(double metres) { return static_cast<int>(std::lround(metres / metres_per_pixel)); }

  void go(double metres) {
    x_ += metres * std::cos(heading_);
    y_ += metres * std::sin(heading_);
  }

  /// Moves along a circle whose centre is on that side: 1 left, -1 right. Returns the x and y of the centre.
  std::pair<double, double> turn_about(double angle, double radius_m, double side) {
    const double centre_x = x_ - side * radius_m * std::sin(heading_);
    const double centre_y = y_ + side * radius_m * std::cos(heading_);
    heading_ += side * angle;
    x_ = centre_x + side * radius_m * std::sin(heading_);
    y_ = centre_y - side * radius_m * std::cos(heading_);
    return {centre_x, centre_y};
  }

  Pen& arc(double degrees, double radius_m, double side) {
    const double angle = degrees * std::numbers::pi / 180;
    const double from = heading_ - side * std::numbers::pi / 2;
    const auto [centre_x, centre_y] = turn_about(angle, radius_m, side);
    (side > 0 ? cairo_arc : cairo_arc_negative)(picture_, centre_x, centre_y, radius_m, from,
                                                from + side * angle);
    return *this;
  }

  cairo_surface_t* surface_;
  cairo_t* picture_;
  double x_, y_, heading_ = 0;
};

/// Four straights and four curves of radius 0.3 m.
bool draw_oval(const std::string& directory) {
  constexpr double radius_m = 0.3;
  Pen pen(2.4, 1.2, 1.2, 0.1);
  pen.forward(0.5).left(90, radius_m).forward(0.4).left(90, radius_m).forward(1.0);
  pen.left(90, radius_m).forward(0.4).left(90, radius_m).forward(0.5).close();
  return pen.write(directory + "/oval.png");
}

/// Half circles of radius 0.2 m, left and right, without a straight between them.
bool draw_curves(const std::string& directory) {
  constexpr double radius_m = 0.2;
  Pen pen(2.4, 1.6, 1.2, 0.2);
  pen.forward(0.8).left(90, radius_m).forward(0.4).left(90, radius_m);
  pen.right(90, radius_m).left(180, radius_m).right(90, radius_m);
  pen.left(90, radius_m).right(180, radius_m).left(90, radius_m);
  pen.left(90, radius_m).forward(0.4).left(90, radius_m).forward(0.8).close();
  return pen.write(directory + "/curves.png");
}

/// Gaps of 2 and 4 cm on straights and of 3 cm in a curve.
bool draw_gap(const std::string& directory) {
  constexpr double radius_m = 0.4;
  Pen pen(2.4, 1.2, 1.2, 0.2);
  pen.forward(0.2).gap(0.02).forward(0.18).left(90, radius_m).gap_left(0.03, radius_m);
  pen.left(90 - 0.03 / radius_m * 180 / std::numbers::pi, radius_m);
  pen.forward(0.38).gap(0.04).forward(0.38).left(180, radius_m).forward(0.41);
  return pen.write(directory + "/gap.png");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: draw_tracks DIRECTORY\n");
    return 2;
  }
  const std::string directory = arguments[1];
  return draw_oval(directory) && draw_curves(directory) && draw_gap(directory) ? 0 : 1;
}
