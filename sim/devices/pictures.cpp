#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "sim/devices/reading.hpp"
#include "sim/rendering/renderer.hpp"
#include "tessera/value_text.hpp"

namespace tessera::sim {
namespace {

/// The number of values of a pixel, and their type.
struct Pixel {
  std::size_t numbers;
  const char* type;
  const char* words;  ///< follow the size of the picture in messages
};
constexpr Pixel colour_pixel{3, "uint8", " in colour"}, depth_pixel{1, "float32", " in depth"},
    label_pixel{1, "uint16", " in labels"};

std::string shown(PictureSize size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}
std::string array_of(const Pixel& pixel, std::size_t numbers) {
  return std::string(pixel.type) + "[" + std::to_string(numbers) + "]";
}

/// "uint8[9216] is 64 x 48 in colour"
std::string example(const Pixel& pixel, PictureSize size) {
  return array_of(pixel, pixel.numbers * size.pixels()) + " is " + shown(size) + pixel.words;
}

/// The first of the usual sizes that has so many pixels.
std::optional<PictureSize> usual_size(std::size_t pixels) {
  constexpr std::array shapes = std::to_array<PictureSize>({{4, 3}, {16, 9}, {1, 1}, {3, 2}, {2, 1}, {5, 4}});
  for (const PictureSize shape : shapes)
    for (int scale = 1; shape.width * scale <= longest_side; ++scale) {
      const PictureSize size{shape.width * scale, shape.height * scale};
      if (size.pixels() == pixels) return size;
      if (size.pixels() > pixels) break;
    }
  return std::nullopt;
}

/// The picture size from the options, which the buffer must fit. Throws DeviceError.
PictureSize picture_size(const DriverRequest& request, Options& options, const Pixel& pixel) {
  const auto layout = ValueLayout::parse(request.type);
  const std::size_t count = layout ? layout->scalars() : 0;
  const std::optional<PictureSize> usual = usual_size(count / pixel.numbers);
  const bool divides = usual && count % pixel.numbers == 0;
  const PictureSize instead = divides ? *usual : PictureSize{64, 48};
  const auto width = options.whole_number("width", 1, longest_side);
  const auto height = options.whole_number("height", 1, longest_side);
  if (!width || !height)
    throw DeviceError("'" + request.kind + "' needs the options width and height",
                      example(pixel, instead) + ": write width: " + std::to_string(instead.width) +
                          ", height: " + std::to_string(instead.height));
  const PictureSize size{*width, *height};
  const bool right_type = layout && std::ranges::all_of(layout->types(), [&](const std::string& one) {
                            return one == pixel.type;
                          });
  if (right_type && count == pixel.numbers * size.pixels()) return size;
  throw DeviceError(example(pixel, size) + ", and the buffer is " + request.type,
                    "make the buffer " + array_of(pixel, pixel.numbers * size.pixels()) +
                        (right_type && divides ? "; " + example(pixel, *usual) : ""));
}

/// Gives the pictures of one camera. The scene is copied with exclusive access to the physics, and drawn
/// after that.
class Camera : public RealReceptor {
 public:
  Camera(const DeviceContext& context, const DriverRequest& request, PictureSize size, PictureKind kind)
      : encoding_(request.encoding),
        simulation_(context.simulation),
        renderer_(context.renderer),
        view_(camera_of(context, request), size, kind) {
    renderer_->make_room_for(size);
  }

  [[nodiscard]] bool open() override {
    simulation_->use([this](const Physics& physics) { renderer_->prepare(physics.model()); });
    return true;
  }
  [[nodiscard]] bool read(std::span<std::byte> value) override {
    if (encoding_ == nullptr) throw std::logic_error("a device that was only judged is used");
    simulation_->use([this](const Physics& physics) {
      renderer_->prepare(physics.model());  // no effect if it was prepared by `open`
      view_.look(physics);
    });
    if (!encoding_->take(value.data(), draw(*renderer_, view_)))
      throw std::logic_error("the buffer has not the size of the picture");
    return true;
  }

 private:
  /// The bytes of the value.
  [[nodiscard]] virtual std::span<const std::byte> draw(Renderer& renderer, CameraView& view) = 0;

  static int camera_of(const DeviceContext& context, const DriverRequest& request) {
    int camera = 0;
    context.simulation->use([&](const Physics& physics) {
      const std::string name = only_target(request);
      camera = element_of(physics, mjOBJ_CAMERA, request, name);
      const double angle = physics.model().cam_fovy[camera];
      if (angle > 0 && angle < 180) return;
      throw DeviceError(
          "camera '" + name + "' has an angle of view (`fovy`) that is not between 0 and 180 degrees", "",
          name);
    });
    return camera;
  }

  const ValueEncoding* encoding_;
  std::shared_ptr<Simulation> simulation_;
  std::shared_ptr<Renderer> renderer_;
  CameraView view_;
};

class ColourCamera final : public Camera {
 public:
  ColourCamera(const DeviceContext& context, const DriverRequest& request, PictureSize size)
      : Camera(context, request, size, PictureKind::colour), rgb_(3 * size.pixels()) {}

 private:
  [[nodiscard]] std::span<const std::byte> draw(Renderer& renderer, CameraView& view) override {
    renderer.draw_colours(view, rgb_);
    return std::as_bytes(std::span(rgb_));
  }
  std::vector<std::uint8_t> rgb_;
};

class DepthCamera final : public Camera {
 public:
  DepthCamera(const DeviceContext& context, const DriverRequest& request, PictureSize size, double noise_m)
      : Camera(context, request, size, PictureKind::depth),
        noise_m_(noise_m),
        random_(context.seed, request.path),
        metres_(size.pixels()) {}

 private:
  [[nodiscard]] std::span<const std::byte> draw(Renderer& renderer, CameraView& view) override {
    renderer.draw_depths(view, metres_);
    const float nothing = view.scene().camera[0].frustum_far;
    if (noise_m_ > 0)
      for (float& metres : metres_)
        if (metres < nothing) metres = static_cast<float>(std::max(0.0, metres + random_.draw(noise_m_)));
    return std::as_bytes(std::span(metres_));
  }
  double noise_m_;
  Noise random_;
  std::vector<float> metres_;
};

class LabelCamera final : public Camera {
 public:
  LabelCamera(const DeviceContext& context, const DriverRequest& request, PictureSize size)
      : Camera(context, request, size, PictureKind::labels),
        rgb_(3 * size.pixels()),
        bodies_(size.pixels()) {}

 private:
  [[nodiscard]] std::span<const std::byte> draw(Renderer& renderer, CameraView& view) override {
    renderer.draw_colours(view, rgb_);
    for (std::size_t pixel = 0; pixel < bodies_.size(); ++pixel)
      bodies_[pixel] = view.body_of(rgb_[3 * pixel], rgb_[3 * pixel + 1], rgb_[3 * pixel + 2]);
    return std::as_bytes(std::span(bodies_));
  }
  std::vector<std::uint8_t> rgb_;
  std::vector<std::uint16_t> bodies_;
};

}  // namespace

std::unique_ptr<RealReceptor> camera(const DeviceContext& context, const DriverRequest& request) {
  Options options(request);
  const PictureSize size = picture_size(request, options, colour_pixel);
  options.refuse_others();
  return std::make_unique<ColourCamera>(context, request, size);
}

std::unique_ptr<RealReceptor> depth(const DeviceContext& context, const DriverRequest& request) {
  Options options(request);
  const PictureSize size = picture_size(request, options, depth_pixel);
  const double noise_m = options.number_from_zero("noise", 0, "m");
  options.refuse_others();
  if (!request.units.empty() && request.units.front() != "m")
    throw DeviceError("a depth is in m, and the buffer in " + request.units.front(), "declare it in m");
  return std::make_unique<DepthCamera>(context, request, size, noise_m);
}

std::unique_ptr<RealReceptor> labels(const DeviceContext& context, const DriverRequest& request) {
  Options options(request);
  const PictureSize size = picture_size(request, options, label_pixel);
  options.refuse_others();
  context.simulation->use([](const Physics& physics) {
    if (physics.model().nbody > std::numeric_limits<std::uint16_t>::max())
      throw DeviceError("the world has more bodies than uint16 has numbers", "");
  });
  return std::make_unique<LabelCamera>(context, request, size);
}

}  // namespace tessera::sim
