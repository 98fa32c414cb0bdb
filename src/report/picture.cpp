#include "report/picture.hpp"

#include <cairo.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "report/colours.hpp"

namespace tessera::report {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Canvas = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

constexpr double margin = 40, heading = 90, legend = 80;  // pixels

std::string png_of(cairo_surface_t* surface) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_write_to_png_stream(surface, append, &bytes);
  return bytes;
}

/// The mean of the pixels that one pixel of the smaller picture covers, softened.
std::uint32_t soft_grey(const sim::Track& floor, std::uint32_t x, std::uint32_t y, std::uint32_t block) {
  std::uint32_t sum = 0;
  std::uint32_t count = 0;
  for (std::uint32_t row = y * block; row < std::min((y + 1) * block, floor.height_px()); ++row) {
    for (std::uint32_t column = x * block; column < std::min((x + 1) * block, floor.width_px());
         ++column, ++count) {
      sum += floor.pixels()[std::size_t{row} * floor.width_px() + column];
    }
  }
  return 255 - (255 - sum / count) * 3 / 10;
}

Surface floor_surface(const sim::Track& floor) {
  const std::uint32_t block = std::max(1U, (std::max(floor.width_px(), floor.height_px()) + 1199) / 1200);
  const std::uint32_t width = (floor.width_px() + block - 1) / block;
  const std::uint32_t height = (floor.height_px() + block - 1) / block;
  Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)),
      cairo_surface_destroy);
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  for (std::uint32_t y = 0; y < height; ++y) {
    auto* const row = reinterpret_cast<std::uint32_t*>(data + y * stride);
    for (std::uint32_t x = 0; x < width; ++x) row[x] = soft_grey(floor, x, y, block) * 0x010101U;
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void set_colour(cairo_t* canvas, const Colour& colour) {
  cairo_set_source_rgb(canvas, colour.red, colour.green, colour.blue);
}

void draw_text(cairo_t* canvas, double x, double y, double size, const std::string& text, double grey,
               bool bold = false) {
  cairo_select_font_face(canvas, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(canvas, size);
  cairo_set_source_rgb(canvas, grey, grey, grey);
  cairo_move_to(canvas, x, y);
  cairo_show_text(canvas, text.c_str());
}

/// Draws in metres, y up.
class FloorCanvas {
 public:
  FloorCanvas(cairo_t* canvas, const DrivenPath& drive, double scale)
      : canvas_(canvas), drive_(drive), scale_(scale) {
    cairo_save(canvas_);
    cairo_translate(canvas_, margin, heading);
    cairo_rectangle(canvas_, 0, 0, drive.floor.width_m() * scale, drive.floor.height_m() * scale);
    cairo_clip(canvas_);
  }
  FloorCanvas(const FloorCanvas&) = delete;
  FloorCanvas& operator=(const FloorCanvas&) = delete;
  ~FloorCanvas() { cairo_restore(canvas_); }

  void floor() {
    const Surface surface = floor_surface(drive_.floor);
    cairo_save(canvas_);
    cairo_scale(canvas_, drive_.floor.width_m() * scale_ / cairo_image_surface_get_width(surface.get()),
                drive_.floor.height_m() * scale_ / cairo_image_surface_get_height(surface.get()));
    cairo_set_source_surface(canvas_, surface.get(), 0, 0);
    cairo_paint(canvas_);
    cairo_restore(canvas_);
  }

  void skeleton() {
    const auto& points = drive_.line.points;
    if (points.empty()) return;
    for (const sim::Point& p : points) cairo_line_to(canvas_, x(p.x_m), y(p.y_m));
    if (drive_.line.closed) cairo_close_path(canvas_);
    const double dash[] = {5, 5};
    cairo_set_dash(canvas_, dash, 2, 0);
    cairo_set_line_width(canvas_, 1);
    cairo_set_source_rgb(canvas_, 0.45, 0.45, 0.45);
    cairo_stroke(canvas_);
    cairo_set_dash(canvas_, nullptr, 0, 0);
  }

  void path(const PathColours& colours) {
    const auto& points = drive_.trace.points;
    const auto chosen = evenly_spaced_indices(points.size(), 6000);
    cairo_set_line_width(canvas_, 3);
    cairo_set_line_cap(canvas_, CAIRO_LINE_CAP_ROUND);
    for (std::size_t i = 1; i < chosen.size(); ++i) {
      const auto& from = points[chosen[i - 1]];
      const auto& to = points[chosen[i]];
      set_colour(canvas_, heat_colour(colours.share[chosen[i]]));
      cairo_move_to(canvas_, x(from.eye_x_m), y(from.eye_y_m));
      cairo_line_to(canvas_, x(to.eye_x_m), y(to.eye_y_m));
      cairo_stroke(canvas_);
    }
  }

  void start() {
    const auto& first = drive_.trace.points.front();
    const double radius = 9;
    cairo_arc(canvas_, x(first.eye_x_m), y(first.eye_y_m), radius, 0, 2 * std::numbers::pi);
    cairo_set_source_rgb(canvas_, 1, 1, 1);
    cairo_fill_preserve(canvas_);
    cairo_set_source_rgb(canvas_, 0.1, 0.1, 0.1);
    cairo_set_line_width(canvas_, 3);
    cairo_stroke(canvas_);
  }

  /// Draws the robot: a disc with wheels at its sides and an arm to the light sensors.
  void robot() {
    const auto& last = drive_.trace.points.back();
    const double arm = std::hypot(last.eye_x_m - last.x_m, last.eye_y_m - last.y_m);
    cairo_save(canvas_);
    cairo_translate(canvas_, x(last.x_m), y(last.y_m));
    cairo_scale(canvas_, scale_, -scale_);
    cairo_rotate(canvas_, last.heading_rad);
    cairo_set_source_rgb(canvas_, 0.1, 0.1, 0.1);
    for (const double side : {-1.0, 1.0}) {
      cairo_rectangle(canvas_, -0.03, side * 0.08 - 0.008, 0.06, 0.016);
      cairo_fill(canvas_);
    }
    cairo_arc(canvas_, 0, 0, 0.065, 0, 2 * std::numbers::pi);
    cairo_set_source_rgba(canvas_, 0.16, 0.35, 0.55, 0.9);
    cairo_fill(canvas_);
    cairo_set_source_rgb(canvas_, 0.1, 0.1, 0.1);
    cairo_set_line_width(canvas_, 0.012);
    cairo_move_to(canvas_, 0, 0);
    cairo_line_to(canvas_, arm, 0);
    cairo_stroke(canvas_);
    cairo_restore(canvas_);
  }

 private:
  [[nodiscard]] double x(double metres) const { return metres * scale_; }
  [[nodiscard]] double y(double metres) const { return (drive_.floor.height_m() - metres) * scale_; }

  cairo_t* canvas_;
  const DrivenPath& drive_;
  double scale_;
};

void draw_legend(cairo_t* canvas, double top, const PathColours& colours) {
  constexpr double width = 260, height = 12;
  const double y = top + 24;
  for (int i = 0; i < static_cast<int>(width); ++i) {
    set_colour(canvas, heat_colour(i / (width - 1)));
    cairo_rectangle(canvas, margin + 18 + i, y, 1.5, height);
    cairo_fill(canvas);
  }
  const std::string unit = colours.by_error
                               ? fmt::format("{:.0f} mm from the middle of the line", colours.top * 1000)
                               : fmt::format("{:.0f} s", colours.top);
  draw_text(canvas, margin, y + height, 15, "0", 0.35);
  draw_text(canvas, margin + width + 30, y + height, 15, unit + "   (ring: start; robot: end)", 0.35);
}

}  // namespace

std::vector<std::size_t> evenly_spaced_indices(std::size_t size, std::size_t count) {
  std::vector<std::size_t> chosen;
  const std::size_t step = std::max<std::size_t>(1, (size + count - 1) / count);
  for (std::size_t i = 0; i < size; i += step) chosen.push_back(i);
  if (!chosen.empty() && chosen.back() + 1 != size) chosen.push_back(size - 1);
  return chosen;
}

PathColours path_colours(const DrivenPath& drive) {
  const auto& points = drive.trace.points;
  PathColours colours{.by_error = !points.empty() && drive.metrics.error_m.size() == points.size(),
                      .share = {}};
  // Rounded up, so that one large error does not hide the others, and pictures can be compared.
  colours.top = colours.by_error ? std::clamp(std::ceil(drive.metrics.max_error_m * 50) / 50, 0.02, 0.1)
                : points.empty() ? 1
                                 : std::max(points.back().t_s, 1e-3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    colours.share.push_back(
        std::min(1.0, (colours.by_error ? std::abs(drive.metrics.error_m[i]) : points[i].t_s) / colours.top));
  }
  return colours;
}

std::string floor_png(const sim::Track& floor) { return png_of(floor_surface(floor).get()); }

std::string path_png(const DrivenPath& drive, const std::string& title, const std::string& figures) {
  const double scale = std::min(1520 / drive.floor.width_m(), 1200 / drive.floor.height_m());
  const double bottom = heading + drive.floor.height_m() * scale;
  const double width = std::max(720.0, drive.floor.width_m() * scale + 2 * margin);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width),
                                                   static_cast<int>(bottom + legend)),
                        cairo_surface_destroy);
  const Canvas canvas(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgb(canvas.get(), 1, 1, 1);
  cairo_paint(canvas.get());
  draw_text(canvas.get(), margin, 40, 26, title, 0.1, true);
  draw_text(canvas.get(), margin, 68, 17, figures, 0.35);
  const PathColours colours = path_colours(drive);
  {
    FloorCanvas floor(canvas.get(), drive, scale);
    floor.floor();
    floor.skeleton();
    if (!drive.trace.points.empty()) {
      floor.path(colours);
      floor.start();
      floor.robot();
    }
  }
  cairo_rectangle(canvas.get(), margin, heading, drive.floor.width_m() * scale,
                  drive.floor.height_m() * scale);
  cairo_set_source_rgb(canvas.get(), 0.75, 0.75, 0.75);
  cairo_set_line_width(canvas.get(), 1);
  cairo_stroke(canvas.get());
  draw_legend(canvas.get(), bottom, colours);
  return png_of(surface.get());
}

}  // namespace tessera::report
