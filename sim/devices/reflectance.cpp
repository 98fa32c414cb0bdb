#include <algorithm>

#include "sim/devices/reading.hpp"

namespace tessera::sim {

std::unique_ptr<RealReceptor> reflectance(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_reals(1, "a light sensor gives");
  Options options(request);
  const double noise = options.number_from_zero("noise", 0.01);
  const double footprint_m = options.number_from_zero("footprint", context.footprint_m, "m");
  options.refuse_others();
  int site = 0;
  context.simulation->use(
      [&](const Physics& physics) { site = element_of(physics, mjOBJ_SITE, request, only_target(request)); });
  const std::size_t eye = context.simulation->add_eye(site, footprint_m);
  return reading(
      context.simulation, std::move(buffer),
      [eye, simulation = context.simulation.get()](const Physics& physics, std::span<double> numbers) {
        numbers[0] = simulation->light_under(physics, eye);
      },
      [noise, random = Noise(context.seed, request.path)](std::span<double> numbers) mutable {
        numbers[0] = std::clamp(numbers[0] + random.draw(noise), 0.0, 1.0);
      });
}

}  // namespace tessera::sim
