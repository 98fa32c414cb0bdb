#include "sim/coppelia/pictures.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/coppelia/targets.hpp"
#include "sim/devices/noise.hpp"
#include "sim/devices/options.hpp"
#include "tessera/value_text.hpp"

namespace tessera::coppelia {
namespace {

using sim::DeviceError;
using sim::Options;

constexpr int longest_side = 4096;

/// The form of a pixel in the buffer of a picture.
struct Pixel {
  std::size_t numbers;
  const char* type;
  std::size_t bytes;  ///< size of all its numbers
  Picture (Simulator::*read)(const Object&);
};
constexpr Pixel colour_pixel{3, "uint8", 3, &Simulator::colours},
    depth_pixel{1, "float32", sizeof(float), &Simulator::depths};

[[noreturn]] void refuse(const DriverRequest& request, const Pixel& pixel, std::size_t width,
                         std::size_t height) {
  const std::string wanted =
      std::string(pixel.type) + "[" + std::to_string(pixel.numbers * width * height) + "]";
  throw DeviceError(wanted + " is " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels, and the buffer is " + request.type,
                    "make the buffer " + wanted);
}

/// Throws DeviceError unless the buffer holds exactly so many pixels.
void require_room(const DriverRequest& request, const Pixel& pixel, std::size_t width, std::size_t height) {
  const auto layout = ValueLayout::parse(request.type);
  const bool right_type = layout && std::ranges::all_of(layout->types(), [&](const std::string& one) {
                            return one == pixel.type;
                          });
  if (!right_type || layout->scalars() != pixel.numbers * width * height)
    refuse(request, pixel, width, height);
}

class Camera final : public RealReceptor {
 public:
  Camera(const DeviceContext& context, const DriverRequest& request, const Pixel& pixel, const Object& sensor,
         double noise)
      : scene_(context.scene),
        encoding_(request.encoding),
        pixel_(pixel),
        sensor_(sensor),
        deviation_(noise),
        noise_(context.seed, request.path) {}

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    if (scene_ == nullptr || encoding_ == nullptr)
      throw std::logic_error("a device that was only judged is used");
    Picture picture = scene_->use([this](Simulator& simulator) { return (simulator.*pixel_.read)(sensor_); });
    turn(picture);
    if (deviation_ > 0) distort(picture.bytes);
    if (!encoding_->take(value.data(), std::as_bytes(std::span(picture.bytes))))
      throw std::runtime_error("the picture has another number of pixels than at the start");
    return true;
  }

 private:
  /// CoppeliaSim begins with the lowest row.
  void turn(Picture& picture) const {
    const std::size_t row = picture.width * pixel_.bytes;
    for (std::size_t low = 0, high = picture.height; low + 1 < high; ++low)
      --high, std::swap_ranges(picture.bytes.data() + low * row, picture.bytes.data() + (low + 1) * row,
                               picture.bytes.data() + high * row);
  }
  void distort(std::vector<std::uint8_t>& bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(float)) {
      float depth_m = 0;
      std::memcpy(&depth_m, &bytes[at], sizeof depth_m);
      depth_m += static_cast<float>(noise_.draw(deviation_));
      std::memcpy(&bytes[at], &depth_m, sizeof depth_m);
    }
  }

  std::shared_ptr<LockStep> scene_;
  const ValueEncoding* encoding_;
  Pixel pixel_;
  Object sensor_;
  double deviation_;
  sim::Noise noise_;
};

std::unique_ptr<RealReceptor> picture(const DeviceContext& context, const DriverRequest& request,
                                      const Pixel& pixel, bool may_have_noise) {
  Options options(request);
  const auto width = options.whole_number("width", 1, longest_side);
  const auto height = options.whole_number("height", 1, longest_side);
  const double noise = may_have_noise ? options.number_from_zero("noise", 0, "m") : 0;
  options.refuse_others();
  if (width && height)
    require_room(request, pixel, static_cast<std::size_t>(*width), static_cast<std::size_t>(*height));
  const Object sensor = only_object_of(context, request, {Object::Type::vision_sensor});
  if (context.scene != nullptr) {
    const auto [columns, rows] =
        context.scene->use([&](Simulator& simulator) { return simulator.resolution(sensor); });
    if ((width && *width != columns) || (height && *height != rows))
      throw DeviceError("vision sensor '" + request.targets[0] + "' has " + std::to_string(columns) + " x " +
                            std::to_string(rows) + " pixels",
                        "leave out width and height, or set the resolution in the scene");
    require_room(request, pixel, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
  }
  return std::make_unique<Camera>(context, request, pixel, sensor, noise);
}

}  // namespace

std::unique_ptr<RealReceptor> camera(const DeviceContext& context, const DriverRequest& request) {
  return picture(context, request, colour_pixel, /*may_have_noise=*/false);
}

std::unique_ptr<RealReceptor> depth(const DeviceContext& context, const DriverRequest& request) {
  return picture(context, request, depth_pixel, /*may_have_noise=*/true);
}

}  // namespace tessera::coppelia
