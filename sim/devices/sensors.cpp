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
  int total = 0;
  context.simulation->use([&](const Physics& physics) {
    for (const std::string& name : request.targets) {
      channels.push_back(channel_of(physics.model(), element_of(physics, mjOBJ_SENSOR, request, name), name));
      if (has_noise) channels.back().deviation = deviation;
      total += channels.back().size;
    }
  });
  buffer.require_reals(static_cast<std::size_t>(total), request.targets.size() == 1
                                                            ? "sensor '" + request.targets[0] + "' gives"
                                                            : "these sensors give");
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
