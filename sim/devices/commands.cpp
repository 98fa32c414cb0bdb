#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/devices/reading.hpp"

namespace tessera::sim {
namespace {

struct Drive {
  int id = 0;
  std::string name;
  bool limited = false;
  double least = 0, most = 0;

  /// The command within the limits; nullopt: it is beyond them. A float32 that is the rounded limit itself is
  /// not beyond it.
  [[nodiscard]] std::optional<double> within(double command, bool clamp) const {
    if (!limited) return command;
    const double inside = std::clamp(command, least, most);
    const double rounding = 1e-6 * std::max(std::abs(least), std::abs(most));
    return clamp || std::abs(command - inside) <= rounding ? std::optional(inside) : std::nullopt;
  }
  [[nodiscard]] std::string refusal(double command) const {
    return fmt::format("actuator '{}' takes {:.4g} to {:.4g}, not {:.6g}", name, least, most, command);
  }
};

Drive drive_of(const mjModel& model, int id, const std::string& name) {
  return {id, name, model.actuator_ctrllimited[id] != 0, model.actuator_ctrlrange[2 * id],
          model.actuator_ctrlrange[2 * id + 1]};
}

/// The unit of a command; empty: the model alone knows it.
std::string unit_of_actuator(const mjModel& model, int id) {
  const bool moves_joint = model.actuator_trntype[id] == mjTRN_JOINT;
  const int joint = model.actuator_trnid[2 * id];
  const bool slides = moves_joint && model.jnt_type[joint] == mjJNT_SLIDE;
  const bool turns = moves_joint && model.jnt_type[joint] == mjJNT_HINGE;
  const bool is_plain = model.actuator_gear[6 * id] == 1 && model.actuator_gaintype[id] == mjGAIN_FIXED;
  if (!is_plain || (!slides && !turns)) return "";
  const mjtNum* const bias = model.actuator_biasprm + mjNBIAS * id;
  const mjtNum gain = model.actuator_gainprm[mjNGAIN * id];
  const bool affine = model.actuator_biastype[id] == mjBIAS_AFFINE && gain != 0;
  const bool to_position = affine && bias[1] == -gain;
  if (model.actuator_dyntype[id] == mjDYN_INTEGRATOR && to_position) return slides ? "m/s" : "rad/s";
  if (model.actuator_dyntype[id] != mjDYN_NONE) return "";
  if (to_position) return slides ? "m" : "rad";
  if (affine && bias[1] == 0 && bias[2] == -gain) return slides ? "m/s" : "rad/s";
  if (model.actuator_biastype[id] == mjBIAS_NONE && gain == 1) return slides ? "N" : "N m";
  return "";
}

/// A joint whose position moves back by a length: a belt.
struct Wrap {
  int joint = 0;
  double length = 0;
};

/// nullopt: there is no option `wrap`. Throws DeviceError if the target cannot move without end.
std::optional<Wrap> wrap_of(const Physics& physics, const DriverRequest& request, Options& options) {
  const auto length = options.number("wrap");
  if (!length) return std::nullopt;
  const std::string& name = only_target(request);
  const mjModel& model = physics.model();
  const int actuator = element_of(physics, mjOBJ_ACTUATOR, request, name);
  const int joint = model.actuator_trnid[2 * actuator];
  const bool moves_joint = model.actuator_trntype[actuator] == mjTRN_JOINT &&
                           (model.jnt_type[joint] == mjJNT_SLIDE || model.jnt_type[joint] == mjJNT_HINGE);
  if (!moves_joint)
    throw DeviceError("'wrap' needs an actuator of a slide or hinge joint, and '" + name + "' is none",
                      "leave the option out", name);
  const char* const unit = model.jnt_type[joint] == mjJNT_SLIDE ? "m" : "rad";
  if (const double in_its_unit = *options.number("wrap", unit); in_its_unit > 0)
    return Wrap{joint, in_its_unit};
  throw DeviceError("option 'wrap' must be more than 0",
                    "a belt with stripes 10 cm apart looks right with wrap: 10 cm", "wrap");
}

}  // namespace

std::unique_ptr<RealEffector> actuator(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options options(request);
  const bool clamp = options.word("outside", {"clamp", "refuse"}) == "clamp";
  std::vector<Drive> drives;
  std::vector<std::string> units;
  std::optional<Wrap> wrap;
  context.simulation->use([&](const Physics& physics) {
    for (const std::string& name : request.targets) {
      drives.push_back(drive_of(physics.model(), element_of(physics, mjOBJ_ACTUATOR, request, name), name));
      units.push_back(unit_of_actuator(physics.model(), drives.back().id));
    }
    wrap = wrap_of(physics, request, options);
  });
  options.refuse_others();
  buffer.require_reals(drives.size(), request.targets.size() == 1
                                          ? "actuator '" + request.targets[0] + "' takes"
                                          : "these actuators take");
  buffer.convert_from(units, "the command of an actuator");
  std::vector<int> ids;
  for (const Drive& drive : drives) ids.push_back(drive.id);
  claim(context, request, mjOBJ_ACTUATOR, ids);
  for (const int id : ids) context.simulation->add_robot_of_actuator(id);
  if (wrap) context.simulation->wrap(wrap->joint, wrap->length);
  return commanding(context.simulation, std::move(buffer),
                    [drives, clamp, path = request.path](Physics& physics, std::span<const double> numbers) {
                      for (std::size_t index = 0; index < drives.size(); ++index)
                        if (!drives[index].within(numbers[index], clamp))
                          throw std::runtime_error(path + ": " + drives[index].refusal(numbers[index]));
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
  claim(context, request, mjOBJ_GEOM, {&geom, 1});
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
