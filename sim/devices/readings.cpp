#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/devices/pose_fields.hpp"
#include "sim/devices/reading.hpp"

namespace tessera::sim {
namespace {

/// A run of numbers in qpos or qvel.
struct Run {
  int at = 0, count = 0;
};

/// The unit of each number of a joint's position or velocity; empty: a part of a quaternion.
std::vector<std::string> units_of_joint(const mjModel& model, int joint, bool velocity) {
  const std::string way = velocity ? "m/s" : "m", angle = velocity ? "rad/s" : "rad";
  switch (model.jnt_type[joint]) {
    case mjJNT_SLIDE:
      return {way};
    case mjJNT_HINGE:
      return {angle};
    case mjJNT_BALL:
      return velocity ? std::vector(3, angle) : std::vector<std::string>(4);
    default:
      return velocity ? std::vector{way, way, way, angle, angle, angle}
                      : std::vector<std::string>{way, way, way, "", "", "", ""};
  }
}

/// velocity: velocities of the joints, not positions.
std::unique_ptr<RealReceptor> joints(const DeviceContext& context, const DriverRequest& request,
                                     bool velocity) {
  Buffer buffer(request);
  Options options(request);
  const double deviation = options.number_from_zero("noise", 0);
  options.refuse_others();
  std::vector<Run> runs;
  std::vector<std::string> units;
  int total = 0;
  context.simulation->use([&](const Physics& physics) {
    const mjModel& model = physics.model();
    for (const std::string& name : request.targets) {
      const int joint = element_of(physics, mjOBJ_JOINT, request, name);
      runs.push_back(velocity ? Run{model.jnt_dofadr[joint], velocity_size(model, joint)}
                              : Run{model.jnt_qposadr[joint], position_size(model, joint)});
      total += runs.back().count;
      const std::vector<std::string> own = units_of_joint(model, joint, velocity);
      units.insert(units.end(), own.begin(), own.end());
    }
  });
  buffer.require_reals(static_cast<std::size_t>(total), request.targets.size() == 1
                                                            ? "joint '" + request.targets[0] + "' gives"
                                                            : "these joints give");
  buffer.convert_from(units, velocity ? "the velocity of a joint" : "the position of a joint");
  Distort distort;
  if (deviation > 0)
    distort = [deviation, random = Noise(context.seed, request.path)](std::span<double> numbers) mutable {
      for (double& number : numbers) number += random.draw(deviation);
    };
  return reading(
      context.simulation, std::move(buffer),
      [runs = std::move(runs), velocity](const Physics& physics, std::span<double> numbers) {
        const mjData& now = physics.positions();
        auto to = numbers.begin();
        for (const Run& run : runs)
          to = std::copy_n((velocity ? now.qvel : now.qpos) + run.at, run.count, to);
      },
      std::move(distort));
}

std::array<double, 7> pose_now(const Physics& physics, const FrameTarget& frame) {
  const mjData& now = physics.positions();
  std::array<double, 7> pose{};
  if (frame.type == mjOBJ_BODY) {
    std::copy_n(now.xpos + 3 * frame.id, 3, pose.begin());
    std::copy_n(now.xquat + 4 * frame.id, 4, pose.begin() + 3);
  } else {
    std::copy_n(now.site_xpos + 3 * frame.id, 3, pose.begin());
    mju_mat2Quat(pose.data() + 3, now.site_xmat + 9 * frame.id);
  }
  return pose;
}

/// The direction of the x axis, seen from above.
double heading_now(const Physics& physics, const FrameTarget& frame) {
  const mjData& now = physics.positions();
  const mjtNum* const axes =
      frame.type == mjOBJ_BODY ? now.xmat + 9 * frame.id : now.site_xmat + 9 * frame.id;
  return std::atan2(axes[3], axes[0]);
}

/// The body with the name of a placed model never moves. Its pose would be a constant, where the user meant
/// the pose of the robot.
void refuse_place_of_model(const mjModel& model, const FrameTarget& frame) {
  if (frame.type != mjOBJ_BODY || model.body_dofnum[frame.id] > 0) return;
  const std::string name = name_of(model, mjOBJ_BODY, frame.id);
  for (int body = frame.id + 1; body < model.nbody; ++body) {
    const std::string part = name_of(model, mjOBJ_BODY, body);
    if (!name.empty() && part.starts_with(name + "/"))
      throw DeviceError("'" + name + "' is the place of a model, which never moves",
                        "name a body in it, such as '" + part.substr(name.size() + 1) + "'");
  }
}

}  // namespace

std::unique_ptr<RealReceptor> joint_position(const DeviceContext& context, const DriverRequest& request) {
  return joints(context, request, false);
}

std::unique_ptr<RealReceptor> joint_velocity(const DeviceContext& context, const DriverRequest& request) {
  return joints(context, request, true);
}

std::unique_ptr<RealReceptor> pose(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options(request).refuse_others();
  FrameTarget frame;
  context.simulation->use([&](const Physics& physics) {
    frame = frame_target(physics, request, only_target(request));
    refuse_place_of_model(physics.model(), frame);
  });
  if (takes_whole_pose(buffer)) {
    buffer.convert_from(units_of_pose, "a pose");
    return reading(context.simulation, std::move(buffer),
                   [frame](const Physics& physics, std::span<double> numbers) {
                     std::ranges::copy(pose_now(physics, frame), numbers.begin());
                   });
  }
  const PlanarFields fields(buffer);
  buffer.convert_from(fields.units(), "a pose");
  return reading(context.simulation, std::move(buffer),
                 [frame, fields](const Physics& physics, std::span<double> numbers) {
                   const std::array<double, 7> all = pose_now(physics, frame);
                   fields.put({all[0], all[1], heading_now(physics, frame)}, numbers);
                 });
}

}  // namespace tessera::sim
