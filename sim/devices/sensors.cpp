#include <algorithm>
#include <cmath>

#include "sim/devices/reading.hpp"

namespace tessera::sim {
namespace {

struct Channel {
  int at = 0, size = 0;  ///< position and number of its values in sensordata
  int datatype = mjDATATYPE_REAL;
  int type = mjSENS_CLOCK;
  double cutoff = 0, deviation = 0;
};

Channel channel_of(const mjModel& model, int id, const std::string& name) {
  if (model.sensor_type[id] == mjSENS_USER)
    throw DeviceError("sensor '" + name + "' is of the type `user`, which gives nothing", "", name);
  return {model.sensor_adr[id],  model.sensor_dim[id],    model.sensor_datatype[id],
          model.sensor_type[id], model.sensor_cutoff[id], model.sensor_noise[id]};
}

/// Empty: it has none, or the model alone knows it.
std::string unit_of_sensor(const mjModel& model, int id) {
  const auto of_joint = [&](const char* slides, const char* turns) {
    return model.jnt_type[model.sensor_objid[id]] == mjJNT_SLIDE ? slides : turns;
  };
  switch (model.sensor_type[id]) {
    case mjSENS_RANGEFINDER:
    case mjSENS_TENDONPOS:
    case mjSENS_FRAMEPOS:
    case mjSENS_SUBTREECOM:
      return "m";
    case mjSENS_VELOCIMETER:
    case mjSENS_TENDONVEL:
    case mjSENS_FRAMELINVEL:
    case mjSENS_SUBTREELINVEL:
      return "m/s";
    case mjSENS_ACCELEROMETER:
    case mjSENS_FRAMELINACC:
      return "m/s^2";
    case mjSENS_GYRO:
    case mjSENS_BALLANGVEL:
    case mjSENS_FRAMEANGVEL:
      return "rad/s";
    case mjSENS_FRAMEANGACC:
      return "rad/s^2";
    case mjSENS_JOINTPOS:
    case mjSENS_JOINTLIMITPOS:
      return of_joint("m", "rad");
    case mjSENS_JOINTVEL:
    case mjSENS_JOINTLIMITVEL:
      return of_joint("m/s", "rad/s");
    case mjSENS_TOUCH:
    case mjSENS_FORCE:
      return "N";
    case mjSENS_TORQUE:
      return "N m";
    case mjSENS_CLOCK:
      return "s";
    default:
      return "";
  }
}

/// A small rotation about an axis in any direction.
void turn(std::span<double> quaternion, double deviation, Noise& random) {
  mjtNum about[3], turned[4], small[4];
  for (mjtNum& part : about) part = random.draw(deviation);
  const mjtNum angle = mju_normalize3(about);
  mju_axisAngle2Quat(small, about, angle);
  mju_mulQuat(turned, quaternion.data(), small);
  std::copy_n(turned, 4, quaternion.begin());
}

/// The noise that the engine adds to each type of data, then the model's cutoff.
void distort(const Channel& channel, std::span<double> numbers, Noise& random) {
  if (channel.deviation <= 0) return;
  // No hit: there is no distance to distort.
  if (channel.type == mjSENS_RANGEFINDER && numbers[0] < 0) return;
  if (channel.datatype == mjDATATYPE_QUATERNION) return turn(numbers, channel.deviation, random);
  for (double& number : numbers) number += random.draw(channel.deviation);
  if (channel.datatype == mjDATATYPE_AXIS) {
    mju_normalize3(numbers.data());
    return;
  }
  const bool positive = channel.datatype == mjDATATYPE_POSITIVE;
  for (double& number : numbers) {
    if (positive) number = std::max(number, 0.0);
    if (channel.cutoff > 0) number = std::clamp(number, positive ? 0 : -channel.cutoff, channel.cutoff);
  }
}

}  // namespace

std::unique_ptr<RealReceptor> sensor(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options options(request);
  const bool has_noise = request.options.contains("noise");
  const double deviation = options.number_from_zero("noise", 0);
  options.refuse_others();
  std::vector<Channel> channels;
  std::vector<std::string> units;
  int total = 0;
  context.simulation->use([&](const Physics& physics) {
    for (const std::string& name : request.targets) {
      channels.push_back(channel_of(physics.model(), element_of(physics, mjOBJ_SENSOR, request, name), name));
      if (has_noise) channels.back().deviation = deviation;
      total += channels.back().size;
      units.insert(units.end(), static_cast<std::size_t>(channels.back().size),
                   unit_of_sensor(physics.model(), element_of(physics, mjOBJ_SENSOR, request, name)));
    }
  });
  buffer.require_reals(static_cast<std::size_t>(total), request.targets.size() == 1
                                                            ? "sensor '" + request.targets[0] + "' gives"
                                                            : "these sensors give");
  buffer.convert_from(units, "a sensor of the world");
  return reading(
      context.simulation, std::move(buffer),
      [channels](const Physics& physics, std::span<double> numbers) {
        const mjData& now = physics.state();
        auto to = numbers.begin();
        for (const Channel& channel : channels)
          to = std::copy_n(now.sensordata + channel.at, channel.size, to);
      },
      [channels, random = Noise(context.seed, request.path)](std::span<double> numbers) mutable {
        for (const Channel& channel : channels) {
          const auto size = static_cast<std::size_t>(channel.size);
          distort(channel, numbers.first(size), random);
          numbers = numbers.subspan(size);
        }
      });
}

}  // namespace tessera::sim
