#include <algorithm>
#include <numbers>

#include "sim/devices/reading.hpp"
#include "sim/engine/rays.hpp"

namespace tessera::sim {
namespace {

/// So many directions from `from` to `to`, both included. A full circle has no two rays in one direction.
std::vector<double> directions(double from, double to, std::size_t count) {
  if (count == 1) return {(from + to) / 2};
  constexpr double almost = 1e-6;
  const bool circle = std::abs(std::abs(to - from) - 2 * std::numbers::pi) < almost;
  const double step = (to - from) / static_cast<double>(circle ? count : count - 1);
  std::vector<double> angles;
  for (std::size_t index = 0; index < count; ++index)
    angles.push_back(from + static_cast<double>(index) * step);
  return angles;
}

}  // namespace

std::unique_ptr<RealReceptor> scan(const DeviceContext& context, const DriverRequest& request) {
  constexpr std::size_t most_rays = 100'000;
  Buffer buffer(request);
  if (!buffer.is_real() || buffer.size() == 0 || buffer.size() > most_rays)
    throw DeviceError("a scan gives one distance for each ray, and the buffer is " + buffer.type(),
                      "make the buffer float32[N] or float64[N], for N rays");
  buffer.convert_from("m", "a scan");
  Options options(request);
  const double from = options.number("from", "rad").value_or(-std::numbers::pi);
  const double to = options.number("to", "rad").value_or(std::numbers::pi);
  const double reach_m = options.number_from_zero("reach", 10, "m");
  const double noise_m = options.number_from_zero("noise", 0, "m");
  const auto groups = options.indices("groups", mjNGROUP - 1).value_or(std::vector<int>());
  options.refuse_others();
  if (std::abs(to - from) > 2 * std::numbers::pi + 1e-6)
    throw DeviceError("a scan goes around once at most", "", "to");
  Fan fan{.site = 0, .angles_rad = directions(from, to, buffer.size()), .reach_m = reach_m, .geoms = {}};
  context.simulation->use([&](const Physics& physics) {
    fan.site = element_of(physics, mjOBJ_SITE, request, only_target(request));
    fan.geoms = geoms_around(physics.model(), fan.site, groups);
  });
  context.simulation->add_robot_of_site(fan.site);
  Distort distort;
  if (noise_m > 0)
    distort = [=, random = Noise(context.seed, request.path)](std::span<double> distances) mutable {
      for (double& distance : distances)  // no hit up to `reach`
        if (distance < reach_m) distance = std::clamp(distance + random.draw(noise_m), 0.0, reach_m);
    };
  return reading(
      context.simulation, std::move(buffer),
      [fan = std::move(fan)](const Physics& physics, std::span<double> numbers) {
        cast(physics, fan, numbers);
      },
      std::move(distort));
}

}  // namespace tessera::sim
