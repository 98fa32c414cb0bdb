#include "sim/rendering/track_picture.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "sim/track.hpp"

namespace tessera::sim {
namespace {

/// Graphics memory is bounded, and so are the textures of some renderers.
constexpr std::uint32_t most_texels = 4096;

struct Pixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Result<Pixels> read_png(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, png.c_str()) == 0) return Problem{png + ": " + image.message};
  if (std::uint64_t{image.width} * image.height > Track::largest_picture_px) {
    png_image_free(&image);
    return Problem{png + " is too large"};
  }
  image.format = PNG_FORMAT_RGB;
  Pixels pixels{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&image, &white, pixels.rgb.data(), 0, nullptr) == 0)
    return Problem{png + ": " + image.message};
  return pixels;
}

/// The begin of part `n` of `parts`.
std::uint32_t begin_of(std::uint32_t n, std::uint32_t parts, std::uint32_t length) {
  return static_cast<std::uint32_t>(std::uint64_t{n} * length / parts);
}

/// Each new pixel is the mean of the pixels that it replaces.
Pixels made_smaller(const Pixels& from) {
  Pixels to{std::min(from.width, most_texels), std::min(from.height, most_texels), {}};
  to.rgb.reserve(std::size_t{3} * to.width * to.height);
  for (std::uint32_t y = 0; y < to.height; ++y)
    for (std::uint32_t x = 0; x < to.width; ++x) {
      const std::uint32_t left = begin_of(x, to.width, from.width),
                          right = begin_of(x + 1, to.width, from.width);
      const std::uint32_t top = begin_of(y, to.height, from.height),
                          bottom = begin_of(y + 1, to.height, from.height);
      std::array<std::size_t, 3> sums{};
      for (std::uint32_t row = top; row < bottom; ++row)
        for (std::uint32_t column = left; column < right; ++column)
          for (std::size_t colour = 0; colour < 3; ++colour)
            sums[colour] += from.rgb[3 * (std::size_t{row} * from.width + column) + colour];
      const std::size_t count = std::size_t{bottom - top} * (right - left);
      for (const std::size_t sum : sums)
        to.rgb.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
    }
  return to;
}

}  // namespace

Result<TrackPicture> TrackPicture::load(const TrackFile& file) {
  Result<Pixels> read = read_png(file.png);
  if (!read) return Problem{read.problem()};
  TrackPicture floor;
  floor.width_m_ = read->width * file.metres_per_pixel;
  floor.height_m_ = read->height * file.metres_per_pixel;
  if (read->width > most_texels || read->height > most_texels) read = made_smaller(*read);
  floor.columns_ = static_cast<int>(read->width);
  floor.rows_ = static_cast<int>(read->height);
  floor.rgb_ = std::move(read->rgb);
  return floor;
}

mjvGeom TrackPicture::geom(int texture) const {
  // Slightly above the floor, so that the floor does not show through.
  constexpr double half_thickness_m = 0.0002;
  const std::array<mjtNum, 3> half_size{width_m_ / 2, height_m_ / 2, half_thickness_m}, middle = half_size;
  constexpr std::array<float, 4> as_the_picture{1, 1, 1, 1};
  mjvGeom geom{};
  mjv_initGeom(&geom, mjGEOM_BOX, half_size.data(), middle.data(), nullptr, as_the_picture.data());
  geom.texid = texture;
  geom.category = mjCAT_STATIC;
  geom.specular = 0;
  geom.reflectance = 0;
  return geom;
}

TexturesWithTrack::TexturesWithTrack(const mjModel& model, const TrackPicture& floor) {
  const auto count = static_cast<std::size_t>(model.ntex);
  const auto with = [count](const int* numbers, int last) {
    std::vector<int> all;
    all.reserve(count + 1);
    if (count > 0) all.assign(numbers, numbers + count);
    all.push_back(last);
    return all;
  };
  types_ = with(model.tex_type, mjTEXTURE_2D);
  heights_ = with(model.tex_height, floor.rows());
  widths_ = with(model.tex_width, floor.columns());
  addresses_ = with(model.tex_adr, model.ntexdata);
  rgb_.reserve(static_cast<std::size_t>(model.ntexdata) + floor.rgb().size());
  if (model.ntexdata > 0) rgb_.assign(model.tex_rgb, model.tex_rgb + model.ntexdata);
  rgb_.insert(rgb_.end(), floor.rgb().begin(), floor.rgb().end());
}

void TexturesWithTrack::lend_to(mjModel& model) {
  model.ntex = static_cast<int>(types_.size());
  model.ntexdata = static_cast<int>(rgb_.size());
  model.tex_type = types_.data();
  model.tex_height = heights_.data();
  model.tex_width = widths_.data();
  model.tex_adr = addresses_.data();
  model.tex_rgb = rgb_.data();
}

}  // namespace tessera::sim
