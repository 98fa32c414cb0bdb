#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/coppelia/devices.hpp"
#include "sim/coppelia/pictures.hpp"
#include "sim/coppelia/targets.hpp"
#include "sim/devices/buffer.hpp"
#include "sim/devices/noise.hpp"
#include "sim/devices/options.hpp"
#include "sim/devices/pose_fields.hpp"

namespace tessera::coppelia {
namespace {

using sim::Buffer;
using sim::DeviceError;
using sim::Options;
using Type = Object::Type;

/// Reads a row of numbers with exclusive access to the simulator. false: there is no value yet.
using Look = std::function<bool(Simulator& simulator, std::span<double> numbers)>;
using Distort = std::function<void(std::span<double> numbers)>;

class Reading final : public RealReceptor {
 public:
  Reading(const DeviceContext& context, Buffer buffer, Look look, Distort distort = {})
      : scene_(context.scene),
        buffer_(std::move(buffer)),
        look_(std::move(look)),
        distort_(std::move(distort)),
        numbers_(buffer_.size()) {}

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    if (scene_ == nullptr) throw std::logic_error("a device that was only judged is used");
    if (!scene_->use([this](Simulator& simulator) { return look_(simulator, numbers_); })) return false;
    if (distort_) distort_(numbers_);
    buffer_.put(numbers_, value);
    return true;
  }

 private:
  std::shared_ptr<LockStep> scene_;
  Buffer buffer_;
  Look look_;
  Distort distort_;
  std::vector<double> numbers_;
};

/// Adds the noise of the option `noise`. Empty: there is none.
Distort noise_of(const DeviceContext& context, const DriverRequest& request, Options& options,
                 double otherwise) {
  const double deviation = options.number_from_zero("noise", otherwise);
  if (deviation == 0) return {};
  return [deviation, random = sim::Noise(context.seed, request.path)](std::span<double> numbers) mutable {
    for (double& number : numbers) number += random.draw(deviation);
  };
}

std::string subject(const DriverRequest& request, const char* word, const char* plural) {
  return request.targets.size() == 1 ? std::string(word) + " '" + request.targets[0] + "' gives"
                                     : std::string("these ") + plural + " give";
}

using ReadJoint = double (Simulator::*)(const Object&);

std::unique_ptr<RealReceptor> joints(const DeviceContext& context, const DriverRequest& request,
                                     ReadJoint read) {
  Buffer buffer(request);
  Options options(request);
  Distort noise = noise_of(context, request, options, 0);
  options.refuse_others();
  buffer.require_reals(request.targets.size(), subject(request, "joint", "joints"));
  buffer.require_si("a joint of the scene");
  return std::make_unique<Reading>(
      context, std::move(buffer),
      [joints = objects_of(context, request, {Type::joint}), read](Simulator& simulator,
                                                                   std::span<double> numbers) {
        for (std::size_t index = 0; index < joints.size(); ++index)
          numbers[index] = (simulator.*read)(joints[index]);
        return true;
      },
      std::move(noise));
}

std::unique_ptr<RealReceptor> joint_position(const DeviceContext& context, const DriverRequest& request) {
  return joints(context, request, &Simulator::joint_position);
}

std::unique_ptr<RealReceptor> joint_velocity(const DeviceContext& context, const DriverRequest& request) {
  return joints(context, request, &Simulator::joint_velocity);
}

/// The number of values that a sensor gives.
std::size_t size_of(const Object& sensor) { return sensor.type == Type::force_sensor ? 6 : 1; }

bool read_sensor(Simulator& simulator, const Object& sensor, std::span<double> numbers) {
  if (sensor.type == Type::force_sensor) {
    const auto force = simulator.force(sensor);
    if (force) std::ranges::copy(*force, numbers.begin());
    return force.has_value();
  }
  const auto distance_m = simulator.distance(sensor);
  if (distance_m) numbers[0] = *distance_m;
  return distance_m.has_value();
}

/// Proximity and force sensors.
std::unique_ptr<RealReceptor> sensor(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options options(request);
  Distort noise = noise_of(context, request, options, 0);
  options.refuse_others();
  if (!buffer.is_real()) buffer.require_reals(buffer.size(), subject(request, "sensor", "sensors"));
  const auto sensors = objects_of(context, request, {Type::proximity_sensor, Type::force_sensor});
  std::size_t count = 0;
  for (const Object& one : sensors) count += size_of(one);
  if (context.scene != nullptr) buffer.require_reals(count, subject(request, "sensor", "sensors"));
  buffer.require_si("a sensor of the scene");
  return std::make_unique<Reading>(
      context, std::move(buffer),
      [sensors](Simulator& simulator, std::span<double> numbers) {
        for (const Object& one : sensors) {
          if (!read_sensor(simulator, one, numbers)) return false;
          numbers = numbers.subspan(size_of(one));
        }
        return true;
      },
      std::move(noise));
}

/// The mean brightness of a vision sensor. So the light sensor sees the same area as its picture.
std::unique_ptr<RealReceptor> reflectance(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_reals(1, "a light sensor gives");
  Options options(request);
  const Distort noise = noise_of(context, request, options, 0.01);
  options.refuse_others();
  return std::make_unique<Reading>(
      context, std::move(buffer),
      [eye = only_object_of(context, request, {Type::vision_sensor})](Simulator& simulator,
                                                                      std::span<double> numbers) {
        const auto brightness = simulator.brightness(eye);
        if (brightness) numbers[0] = *brightness;
        return brightness.has_value();
      },
      [noise](std::span<double> numbers) {
        if (noise) noise(numbers);
        numbers[0] = std::clamp(numbers[0], 0.0, 1.0);
      });
}

/// The direction of the x axis, seen from above. quaternion: w, x, y, z.
double heading_of(std::span<const double> quaternion) {
  const double w = quaternion[0], x = quaternion[1], y = quaternion[2], z = quaternion[3];
  return std::atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
}

std::unique_ptr<RealReceptor> pose(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options(request).refuse_others();
  const Object object = only_object_of(context, request, {});
  if (takes_whole_pose(buffer)) {
    buffer.convert_from(sim::units_of_pose, "a pose");
    return std::make_unique<Reading>(context, std::move(buffer),
                                     [object](Simulator& simulator, std::span<double> numbers) {
                                       std::ranges::copy(simulator.pose(object), numbers.begin());
                                       return true;
                                     });
  }
  const sim::PlanarFields fields(buffer);
  buffer.convert_from(fields.units(), "a pose");
  return std::make_unique<Reading>(
      context, std::move(buffer), [object, fields](Simulator& simulator, std::span<double> numbers) {
        const std::array<double, 7> all = simulator.pose(object);
        fields.put({all[0], all[1], heading_of(std::span(all).subspan(3))}, numbers);
        return true;
      });
}

}  // namespace

std::unique_ptr<RealReceptor> make_receptor(const DeviceContext& context, const DriverRequest& request) {
  using Make = std::unique_ptr<RealReceptor> (*)(const DeviceContext&, const DriverRequest&);
  constexpr auto kinds = std::to_array<std::pair<std::string_view, Make>>({{"sensor", sensor},
                                                                           {"joint_position", joint_position},
                                                                           {"joint_velocity", joint_velocity},
                                                                           {"pose", pose},
                                                                           {"camera", camera},
                                                                           {"depth", depth},
                                                                           {"reflectance", reflectance}});
  const auto kind = std::ranges::find(kinds, request.kind, &std::pair<std::string_view, Make>::first);
  if (kind != kinds.end()) return kind->second(context, request);
  std::string names;
  for (const auto& [name, make] : kinds) names += (names.empty() ? "" : ", ") + std::string(name);
  throw DeviceError("worlds of CoppeliaSim have no receptor '" + request.kind + "'", "they have " + names);
}

}  // namespace tessera::coppelia
