#include <algorithm>
#include <cmath>

#include "sim/devices/reading.hpp"

namespace tessera::sim {
namespace {

struct Drive {
  int id = 0;
  bool limited = false;
  double least = 0, most = 0;

  /// The command within the limits; nullopt: it is beyond them. A float32 that is the limit itself, rounded,
  /// is not beyond it.
  [[nodiscard]] std::optional<double> within(double command, bool clamp) const {
    if (!limited) return command;
    const double inside = std::clamp(command, least, most);
    const double rounding = 1e-6 * std::max(std::abs(least), std::abs(most));
    return clamp || std::abs(command - inside) <= rounding ? std::optional(inside) : std::nullopt;
  }
};

Drive drive_of(const mjModel& model, int id) {
  return {id, model.actuator_ctrllimited[id] != 0, model.actuator_ctrlrange[2 * id],
          model.actuator_ctrlrange[2 * id + 1]};
}

}  // namespace

std::unique_ptr<RealEffector> actuator(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options options(request);
  const bool clamp = options.word("outside", {"clamp", "refuse"}) == "clamp";
  options.refuse_others();
  std::vector<Drive> drives;
  context.simulation->use([&](const Physics& physics) {
    for (const std::string& name : request.targets)
      drives.push_back(drive_of(physics.model(), element_of(physics, mjOBJ_ACTUATOR, request, name)));
  });
  buffer.require_reals(drives.size(), request.targets.size() == 1
                                          ? "actuator '" + request.targets[0] + "' takes"
                                          : "these actuators take");
  for (const Drive& drive : drives) context.simulation->add_robot_of_actuator(drive.id);
  return commanding(context.simulation, std::move(buffer),
                    [drives, clamp](Physics& physics, std::span<const double> numbers) {
                      for (std::size_t index = 0; index < drives.size(); ++index)
                        if (!drives[index].within(numbers[index], clamp)) return false;
                      for (std::size_t index = 0; index < drives.size(); ++index)
                        physics.command(drives[index].id, *drives[index].within(numbers[index], clamp));
                      return true;
                    });
}

std::unique_ptr<RealEffector> colour(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_reals(4, "a colour takes");
  Options(request).refuse_others();
  int geom = 0;
  context.simulation->use(
      [&](const Physics& physics) { geom = element_of(physics, mjOBJ_GEOM, request, only_target(request)); });
  return commanding(context.simulation, std::move(buffer),
                    [geom](Physics& physics, std::span<const double> rgba) {
                      if (!std::ranges::all_of(rgba, [](double part) { return part >= 0 && part <= 1; }))
                        return false;
                      const std::vector<float> parts(rgba.begin(), rgba.end());
                      physics.before_next_step([geom, parts](mjModel& model, mjData&, const mjData&) {
                        std::ranges::copy(parts, model.geom_rgba + 4 * geom);
                      });
                      return true;
                    });
}

}  // namespace tessera::sim
