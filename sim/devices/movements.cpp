#include <algorithm>
#include <array>
#include <cmath>

#include "sim/devices/pose_fields.hpp"
#include "sim/devices/reading.hpp"

namespace tessera::sim {
namespace {

using PoseNumbers = std::array<double, 7>;  // x y z, quaternion w x y z

/// Seven zeros, as in a buffer that was never written: no movement.
bool is_no_pose(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return number == 0; });
}

/// nullopt: the quaternion has no direction.
std::optional<PoseNumbers> pose_of(std::span<const double> numbers) {
  PoseNumbers pose{};
  std::ranges::copy(numbers, pose.begin());
  constexpr double least = 1e-6;
  if (mju_norm(pose.data() + 3, 4) < least) return std::nullopt;
  mju_normalize4(pose.data() + 3);
  return pose;
}

/// Makes the two bodies keep their present relative pose. For a weld, `data` of the engine has a point of
/// body 2, the same point in body 1, and the quaternion of body 2 in body 1; for a connection, the point in
/// body 1, then in body 2.
void take_pose_of_the_moment(mjModel& model, int equality, const mjData& now) {
  const int one = model.eq_obj1id[equality], two = model.eq_obj2id[equality];
  mjtNum* const data = model.eq_data + mjNEQDATA * equality;
  const auto carry = [&](const mjtNum* from, int body, mjtNum* to, int other) {
    mjtNum turned[3], apart[3];
    mju_rotVecMat(turned, from, now.xmat + 9 * body);
    mju_add3(turned, turned, now.xpos + 3 * body);
    mju_sub3(apart, turned, now.xpos + 3 * other);
    mju_rotVecMatT(to, apart, now.xmat + 9 * other);
  };
  if (model.eq_type[equality] == mjEQ_CONNECT) carry(data, one, data + 3, two);
  if (model.eq_type[equality] != mjEQ_WELD) return;
  carry(data, two, data + 3, one);
  mjtNum back[4];
  mju_negQuat(back, now.xquat + 4 * one);
  mju_mulQuat(data + 6, back, now.xquat + 4 * two);
}

int free_joint_of(const mjModel& model, int body) {
  const int joint = model.body_jntadr[body];
  return joint >= 0 && model.jnt_type[joint] == mjJNT_FREE ? joint : -1;
}

}  // namespace

std::unique_ptr<RealEffector> weld(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_flag("a weld takes");
  Options(request).refuse_others();
  int equality = 0;
  context.simulation->use([&](const Physics& physics) {
    equality = element_of(physics, mjOBJ_EQUALITY, request, only_target(request));
  });
  claim(context, request, mjOBJ_EQUALITY, {&equality, 1});
  return commanding(context.simulation, std::move(buffer),
                    [equality](Physics& physics, std::span<const double> numbers) {
                      const bool on = numbers[0] != 0;
                      physics.before_next_step([equality, on](mjModel& model, mjData&, const mjData& now) {
                        if (on && model.eq_active[equality] == 0)
                          take_pose_of_the_moment(model, equality, now);
                        model.eq_active[equality] = on ? 1 : 0;
                      });
                      return true;
                    });
}

std::unique_ptr<RealEffector> mocap(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_reals(7, "a pose takes");
  buffer.convert_from(units_of_pose, "a pose");
  Options(request).refuse_others();
  const std::string& name = only_target(request);
  int body = -1, mocap_body = -1;
  context.simulation->use([&](const Physics& physics) {
    body = element_of(physics, mjOBJ_BODY, request, name);
    mocap_body = physics.model().body_mocapid[body];
  });
  if (mocap_body < 0)
    throw DeviceError("body '" + name + "' is no mocap body",
                      "give it mocap=\"true\" in the model; `place` moves bodies with a free joint", name);
  claim(context, request, mjOBJ_BODY, {&body, 1});
  return commanding(
      context.simulation, std::move(buffer), [mocap_body](Physics& physics, std::span<const double> numbers) {
        if (is_no_pose(numbers)) return true;
        const auto pose = pose_of(numbers);
        if (!pose) return false;
        physics.before_next_step([mocap_body, at = *pose](mjModel&, mjData& state, const mjData&) {
          std::copy_n(at.begin(), 3, state.mocap_pos + 3 * mocap_body);
          std::copy_n(at.begin() + 3, 4, state.mocap_quat + 4 * mocap_body);
        });
        return true;
      });
}

std::unique_ptr<RealEffector> place(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_reals(7, "a pose takes");
  buffer.convert_from(units_of_pose, "a pose");
  Options(request).refuse_others();
  const std::string& name = only_target(request);
  int body = -1, joint = -1;
  context.simulation->use([&](const Physics& physics) {
    body = element_of(physics, mjOBJ_BODY, request, name);
    joint = free_joint_of(physics.model(), body);
  });
  if (joint < 0)
    throw DeviceError("body '" + name + "' has no free joint, so it cannot be put anywhere",
                      "`mocap` moves bodies with mocap=\"true\"", name);
  claim(context, request, mjOBJ_BODY, {&body, 1});
  return commanding(
      context.simulation, std::move(buffer), [joint](Physics& physics, std::span<const double> numbers) {
        if (is_no_pose(numbers)) return true;
        const auto pose = pose_of(numbers);
        if (!pose) return false;
        physics.before_next_step([joint, at = *pose](mjModel& model, mjData& state, const mjData&) {
          std::ranges::copy(at, state.qpos + model.jnt_qposadr[joint]);
          std::fill_n(state.qvel + model.jnt_dofadr[joint], 6, 0.0);
        });
        return true;
      });
}

}  // namespace tessera::sim
