#include "sim/compose/keyframe.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "sim/compose/frame.hpp"
#include "tessera/nearest.hpp"

namespace tessera::sim {
namespace {

std::string name_in(const mjModel& model, mjtObj type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr ? name : "";
}

std::string no_keyframe(const ModelFile& file, const std::string& wanted) {
  std::vector<std::string> names;
  std::string list;
  for (int key = 0; key < file.alone->nkey; ++key) {
    names.push_back(name_in(*file.alone, mjOBJ_KEY, key));
    list += (key > 0 ? ", " : "") + (names.back().empty() ? "one without a name" : names.back());
  }
  const std::string text = file.path + ": has no keyframe '" + wanted + "'; " +
                           (list.empty() ? "it has none at all" : "it has " + list);
  return with_hint(text, did_you_mean(wanted, names));
}

struct Count {
  int position, velocity;
};
Count numbers_of_joint(int type) {
  if (type == mjJNT_FREE) return {7, 6};
  if (type == mjJNT_BALL) return {4, 3};
  return {1, 1};
}

/// The state of a free joint is in the coordinates of the world.
void move_free_joint(InitialValues::Joint& joint, const Frame& frame) {
  const Frame moved = frame.of(joint.position.data(), joint.position.data() + 3);
  std::ranges::copy(moved.position, joint.position.begin());
  std::ranges::copy(moved.quaternion, joint.position.begin() + 3);
  std::array<mjtNum, 3> velocity{};
  mju_rotVecQuat(velocity.data(), joint.velocity.data(), frame.quaternion.data());
  std::ranges::copy(velocity, joint.velocity.begin());
}

InitialValues::Joint joint_value(const mjModel& alone, int key, int joint) {
  const Count count = numbers_of_joint(alone.jnt_type[joint]);
  const mjtNum* position = alone.key_qpos + key * alone.nq + alone.jnt_qposadr[joint];
  const mjtNum* velocity = alone.key_qvel + key * alone.nv + alone.jnt_dofadr[joint];
  return {name_in(alone, mjOBJ_JOINT, joint),
          {position, position + count.position},
          {velocity, velocity + count.velocity}};
}

/// The index of an actuator's one state number; -1: it has none.
int activation_of(const mjModel& model, int actuator) {
  const bool has_state = model.actuator_dyntype[actuator] != mjDYN_NONE;
  return has_state ? actuator - (model.nu - model.na) : -1;
}

void copy_to(const std::vector<double>& from, std::vector<double>& to, int at) {
  std::ranges::copy(from, to.begin() + at);
}

std::vector<double> all(const mjtNum* values, int count) { return {values, values + count}; }

}  // namespace

std::optional<Problem> add_initial_values(const ModelFile& file, const Placement& placement,
                                          InitialValues& values) {
  if (!placement.keyframe) return std::nullopt;
  const mjModel& alone = *file.alone;
  const int key = mj_name2id(&alone, mjOBJ_KEY, placement.keyframe->c_str());
  if (key < 0 || placement.keyframe->empty()) return Problem{no_keyframe(file, *placement.keyframe)};
  const std::string prefix = placement.name + "/";
  for (int joint = 0; joint < alone.njnt; ++joint) {
    InitialValues::Joint value = joint_value(alone, key, joint);
    value.name = prefix + value.name;
    if (alone.jnt_type[joint] == mjJNT_FREE) move_free_joint(value, frame_of(placement));
    values.joints.push_back(std::move(value));
  }
  for (int actuator = 0; actuator < alone.nu; ++actuator) {
    const int state = activation_of(alone, actuator);
    values.actuators.push_back(
        {prefix + name_in(alone, mjOBJ_ACTUATOR, actuator), alone.key_ctrl[key * alone.nu + actuator],
         state < 0 ? std::vector<double>{} : std::vector<double>{alone.key_act[key * alone.na + state]}});
  }
  for (int body = 0; body < alone.nbody; ++body) {
    const int mocap = alone.body_mocapid[body];
    if (mocap < 0) continue;
    const Frame moved = frame_of(placement).of(alone.key_mpos + 3 * (key * alone.nmocap + mocap),
                                               alone.key_mquat + 4 * (key * alone.nmocap + mocap));
    values.mocap_bodies.push_back({prefix + name_in(alone, mjOBJ_BODY, body),
                                   {moved.position.begin(), moved.position.end()},
                                   {moved.quaternion.begin(), moved.quaternion.end()}});
  }
  return std::nullopt;
}

InitialState initial_state(const mjModel& model, const InitialValues& values) {
  InitialState state{all(model.qpos0, model.nq),
                     std::vector<double>(static_cast<std::size_t>(model.nv)),
                     std::vector<double>(static_cast<std::size_t>(model.na)),
                     std::vector<double>(static_cast<std::size_t>(model.nu)),
                     std::vector<double>(static_cast<std::size_t>(3 * model.nmocap)),
                     std::vector<double>(static_cast<std::size_t>(4 * model.nmocap))};
  for (int body = 0; body < model.nbody; ++body) {
    const int mocap = model.body_mocapid[body];
    if (mocap < 0) continue;
    copy_to(all(model.body_pos + 3 * body, 3), state.mocap_positions, 3 * mocap);
    copy_to(all(model.body_quat + 4 * body, 4), state.mocap_quaternions, 4 * mocap);
  }
  for (const InitialValues::Joint& joint : values.joints) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0) continue;
    copy_to(joint.position, state.positions, model.jnt_qposadr[id]);
    copy_to(joint.velocity, state.velocities, model.jnt_dofadr[id]);
  }
  for (const InitialValues::Actuator& actuator : values.actuators) {
    const int id = mj_name2id(&model, mjOBJ_ACTUATOR, actuator.name.c_str());
    if (id < 0) continue;
    copy_to({actuator.control}, state.controls, id);
    if (!actuator.activation.empty() && activation_of(model, id) >= 0)
      copy_to(actuator.activation, state.activations, activation_of(model, id));
  }
  for (const InitialValues::MocapBody& body : values.mocap_bodies) {
    const int id = mj_name2id(&model, mjOBJ_BODY, body.name.c_str());
    if (id < 0 || model.body_mocapid[id] < 0) continue;
    copy_to(body.position, state.mocap_positions, 3 * model.body_mocapid[id]);
    copy_to(body.quaternion, state.mocap_quaternions, 4 * model.body_mocapid[id]);
  }
  return state;
}

}  // namespace tessera::sim
