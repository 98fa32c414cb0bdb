#include "report/frame.hpp"

#include <cairo.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>

#include "report/text.hpp"

namespace tessera::report {
namespace {

using FrameSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

[[nodiscard]] FrameSurface surface_of(const Frame& frame) {
  FrameSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, frame.width, frame.height),
                       cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error("there is no memory for a picture of this size");
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const std::uint8_t* from = frame.rgb.data();
  for (int y = 0; y < frame.height; ++y) {
    auto* const row = reinterpret_cast<std::uint32_t*>(data + static_cast<std::size_t>(y) * stride);
    for (int x = 0; x < frame.width; ++x, from += 3)
      row[x] =
          static_cast<std::uint32_t>(from[0]) << 16U | static_cast<std::uint32_t>(from[1]) << 8U | from[2];
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void take_back(Frame& frame, cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  const unsigned char* const data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  std::uint8_t* to = frame.rgb.data();
  for (int y = 0; y < frame.height; ++y) {
    const auto* const row =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::size_t>(y) * stride);
    for (int x = 0; x < frame.width; ++x, to += 3) {
      to[0] = static_cast<std::uint8_t>(row[x] >> 16U);
      to[1] = static_cast<std::uint8_t>(row[x] >> 8U);
      to[2] = static_cast<std::uint8_t>(row[x]);
    }
  }
}

/// White or red letters on a dark box, so that they are read on every ground.
class CaptionPen {
 public:
  CaptionPen(cairo_t* canvas, const Frame& frame)
      : canvas_(canvas), width_(frame.width), size_(std::clamp(frame.height / 28.0, 11.0, 26.0)) {
    cairo_set_font_size(canvas_, size_);
  }
  [[nodiscard]] double row() const { return 1.7 * size_; }
  void write(const std::string& text, double baseline, bool alarm) {
    cairo_select_font_face(canvas_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           alarm ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    const std::string shown = fitting(text);
    cairo_text_extents_t extents;
    cairo_text_extents(canvas_, shown.c_str(), &extents);
    cairo_rectangle(canvas_, 0.4 * size_, baseline - 1.15 * size_, extents.x_advance + size_, 1.6 * size_);
    if (alarm)
      cairo_set_source_rgba(canvas_, 0.70, 0.08, 0.06, 0.88);
    else
      cairo_set_source_rgba(canvas_, 0.05, 0.07, 0.09, 0.62);
    cairo_fill(canvas_);
    cairo_set_source_rgb(canvas_, 1, 1, 1);
    cairo_move_to(canvas_, 0.9 * size_, baseline);
    cairo_show_text(canvas_, shown.c_str());
  }

 private:
  [[nodiscard]] std::string fitting(const std::string& text) const {
    std::string shown = drawable(shortened(text, 300, 1));
    for (std::size_t most = shown.size(); most > 8; most -= 4) {
      cairo_text_extents_t extents;
      cairo_text_extents(canvas_, shown.c_str(), &extents);
      if (extents.x_advance < width_ - 2 * size_) break;
      shown = shortened(shown, most, 1);
    }
    return shown;
  }
  cairo_t* canvas_;
  double width_, size_;
};

}  // namespace

void put_caption(Frame& frame, const Caption& caption) {
  constexpr std::size_t most_alarms = 4;
  const FrameSurface surface = surface_of(frame);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> canvas(cairo_create(surface.get()), cairo_destroy);
  CaptionPen pen(canvas.get(), frame);
  double baseline = pen.row();
  if (!caption.title.empty()) pen.write(caption.title, baseline, false);
  for (std::size_t index = 0; index < std::min(most_alarms, caption.alarms.size()); ++index)
    pen.write(caption.alarms[index], baseline += pen.row(), true);
  if (!caption.time.empty()) pen.write(caption.time, frame.height - 0.6 * pen.row(), false);
  take_back(frame, surface.get());
}

std::string png_of(const Frame& frame) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_write_to_png_stream(surface_of(frame).get(), append, &bytes);
  return bytes;
}

}  // namespace tessera::report
