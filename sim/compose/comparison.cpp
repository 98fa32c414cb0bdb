#include "sim/compose/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

#include "sim/compose/frame.hpp"
#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

constexpr double tolerance = 1e-12;
constexpr std::size_t most_listed = 10;

/// Compares one instance. `Rows` of numbers are found through pointers to members of mjModel.
class InstanceComparison {
 public:
  InstanceComparison(const mjModel& composed, const PlacedModel& placed)
      : composed_(composed), alone_(*placed.alone), placement_(placed.placement) {}

  [[nodiscard]] std::vector<std::string> run() {
    compare_bodies();
    compare_joints();
    compare_geoms();
    compare_sites_and_cameras();
    compare_actuators();
    compare_tendons_and_equalities();
    compare_sensors();
    return std::move(found_);
  }

 private:
  struct Pair {
    int alone, composed;
    std::string name;
  };
  void note(const std::string& what) {
    if (found_.size() < most_listed) found_.push_back(what);
  }
  /// The named elements of a type, in both models.
  std::vector<Pair> pairs(mjtObj type, int count, const char* kind) {
    std::vector<Pair> all;
    kind_ = kind;
    for (int id = 0; id < count; ++id) {
      const char* name = mj_id2name(&alone_, type, id);
      if (name == nullptr || *name == '\0' || (type == mjOBJ_BODY && id == 0)) continue;
      const int other = mj_name2id(&composed_, type, (placement_.name + "/" + name).c_str());
      if (other < 0) {
        note(std::string("there is no ") + kind + " '" + name + "'");
      } else {
        all.push_back({id, other, name});
      }
    }
    return all;
  }
  template <class Number>
  void equal(const char* what, const Pair& pair, const Number* alone, const Number* composed, int width) {
    for (int i = 0; i < width; ++i) {
      const double a = static_cast<double>(alone[i]), b = static_cast<double>(composed[i]);
      if (std::abs(a - b) <= tolerance * std::max(1.0, std::abs(a))) continue;
      note(std::string(what) + " of " + kind_ + " '" + pair.name + "': " + numbers_text(&b, 1) + ", not " +
           numbers_text(&a, 1));
      return;
    }
  }
  template <class Number>
  void row(const char* what, const Pair& pair, Number* mjModel::*values, int width = 1) {
    equal(what, pair, alone_.*values + width * pair.alone, composed_.*values + width * pair.composed, width);
  }
  /// Compares frames. The frame of a child of the world moves with the placement, if it is also a child of
  /// the world in the composed world.
  void frame(const Pair& pair, mjtNum* mjModel::*positions, mjtNum* mjModel::*quaternions, bool is_moved) {
    const mjtNum* position = alone_.*positions + 3 * pair.alone;
    const mjtNum* quaternion = alone_.*quaternions + 4 * pair.alone;
    Frame expected{{position[0], position[1], position[2]},
                   {quaternion[0], quaternion[1], quaternion[2], quaternion[3]}};
    if (is_moved) expected = frame_of(placement_).of(position, quaternion);
    equal("position", pair, expected.position.data(), composed_.*positions + 3 * pair.composed, 3);
    equal("orientation", pair, expected.quaternion.data(), composed_.*quaternions + 4 * pair.composed, 4);
  }

  void compare_bodies() {
    for (const Pair& body : pairs(mjOBJ_BODY, alone_.nbody, "body")) {
      row("mass", body, &mjModel::body_mass);
      row("inertia", body, &mjModel::body_inertia, 3);
      row("inertial position", body, &mjModel::body_ipos, 3);
      row("inertial orientation", body, &mjModel::body_iquat, 4);
      row("number of joints", body, &mjModel::body_jntnum);
      row("number of geoms", body, &mjModel::body_geomnum);
      frame(body, &mjModel::body_pos, &mjModel::body_quat, composed_.body_parentid[body.composed] == 0);
    }
  }
  void compare_joints() {
    for (const Pair& joint : pairs(mjOBJ_JOINT, alone_.njnt, "joint")) {
      row("type", joint, &mjModel::jnt_type);
      row("limited", joint, &mjModel::jnt_limited);
      row("range", joint, &mjModel::jnt_range, 2);
      row("position", joint, &mjModel::jnt_pos, 3);
      row("axis", joint, &mjModel::jnt_axis, 3);
      row("stiffness", joint, &mjModel::jnt_stiffness);
      row("margin", joint, &mjModel::jnt_margin);
      if (alone_.jnt_type[joint.alone] != composed_.jnt_type[joint.composed]) continue;
      Pair dof = joint;
      dof.alone = alone_.jnt_dofadr[joint.alone];
      dof.composed = composed_.jnt_dofadr[joint.composed];
      row("damping", dof, &mjModel::dof_damping);
      row("armature", dof, &mjModel::dof_armature);
      row("friction loss", dof, &mjModel::dof_frictionloss);
      if (alone_.jnt_type[joint.alone] == mjJNT_FREE) continue;
      Pair coordinate = joint;
      coordinate.alone = alone_.jnt_qposadr[joint.alone];
      coordinate.composed = composed_.jnt_qposadr[joint.composed];
      row("reference", coordinate, &mjModel::qpos0);
      row("spring reference", coordinate, &mjModel::qpos_spring);
    }
  }
  void compare_geoms() {
    for (const Pair& geom : pairs(mjOBJ_GEOM, alone_.ngeom, "geom")) {
      row("type", geom, &mjModel::geom_type);
      row("contype", geom, &mjModel::geom_contype);
      row("conaffinity", geom, &mjModel::geom_conaffinity);
      row("condim", geom, &mjModel::geom_condim);
      row("group", geom, &mjModel::geom_group);
      row("priority", geom, &mjModel::geom_priority);
      row("size", geom, &mjModel::geom_size, 3);
      row("friction", geom, &mjModel::geom_friction, 3);
      row("margin", geom, &mjModel::geom_margin);
      row("gap", geom, &mjModel::geom_gap);
      row("solref", geom, &mjModel::geom_solref, mjNREF);
      row("solimp", geom, &mjModel::geom_solimp, mjNIMP);
      row("colour", geom, &mjModel::geom_rgba, 4);
      const bool moved = alone_.geom_bodyid[geom.alone] == 0 && composed_.geom_bodyid[geom.composed] == 0;
      frame(geom, &mjModel::geom_pos, &mjModel::geom_quat, moved);
    }
  }
  void compare_sites_and_cameras() {
    for (const Pair& site : pairs(mjOBJ_SITE, alone_.nsite, "site")) {
      row("type", site, &mjModel::site_type);
      row("size", site, &mjModel::site_size, 3);
      frame(site, &mjModel::site_pos, &mjModel::site_quat, false);
    }
    for (const Pair& camera : pairs(mjOBJ_CAMERA, alone_.ncam, "camera")) {
      row("mode", camera, &mjModel::cam_mode);
      row("field of view", camera, &mjModel::cam_fovy);
      frame(camera, &mjModel::cam_pos, &mjModel::cam_quat, false);
    }
  }
  void compare_actuators() {
    for (const Pair& actuator : pairs(mjOBJ_ACTUATOR, alone_.nu, "actuator")) {
      row("transmission", actuator, &mjModel::actuator_trntype);
      row("dynamics", actuator, &mjModel::actuator_dyntype);
      row("gain type", actuator, &mjModel::actuator_gaintype);
      row("bias type", actuator, &mjModel::actuator_biastype);
      row("dynamics parameters", actuator, &mjModel::actuator_dynprm, mjNDYN);
      row("gain", actuator, &mjModel::actuator_gainprm, mjNGAIN);
      row("bias", actuator, &mjModel::actuator_biasprm, mjNBIAS);
      row("control limited", actuator, &mjModel::actuator_ctrllimited);
      row("force limited", actuator, &mjModel::actuator_forcelimited);
      row("state limited", actuator, &mjModel::actuator_actlimited);
      row("control range", actuator, &mjModel::actuator_ctrlrange, 2);
      row("force range", actuator, &mjModel::actuator_forcerange, 2);
      row("state range", actuator, &mjModel::actuator_actrange, 2);
      row("gear", actuator, &mjModel::actuator_gear, 6);
      row("crank length", actuator, &mjModel::actuator_cranklength);
      row("length range", actuator, &mjModel::actuator_lengthrange, 2);
    }
  }
  void compare_tendons_and_equalities() {
    for (const Pair& tendon : pairs(mjOBJ_TENDON, alone_.ntendon, "tendon")) {
      row("number of parts", tendon, &mjModel::tendon_num);
      row("limited", tendon, &mjModel::tendon_limited);
      row("range", tendon, &mjModel::tendon_range, 2);
      row("stiffness", tendon, &mjModel::tendon_stiffness);
      row("damping", tendon, &mjModel::tendon_damping);
      row("friction loss", tendon, &mjModel::tendon_frictionloss);
      row("spring length", tendon, &mjModel::tendon_lengthspring);
      row("length", tendon, &mjModel::tendon_length0);
    }
    for (const Pair& equality : pairs(mjOBJ_EQUALITY, alone_.neq, "equality")) {
      row("type", equality, &mjModel::eq_type);
      row("active", equality, &mjModel::eq_active);
      row("data", equality, &mjModel::eq_data, mjNEQDATA);
      row("solref", equality, &mjModel::eq_solref, mjNREF);
      row("solimp", equality, &mjModel::eq_solimp, mjNIMP);
    }
  }
  void compare_sensors() {
    for (const Pair& sensor : pairs(mjOBJ_SENSOR, alone_.nsensor, "sensor")) {
      row("type", sensor, &mjModel::sensor_type);
      row("object type", sensor, &mjModel::sensor_objtype);
      row("dimension", sensor, &mjModel::sensor_dim);
      row("cutoff", sensor, &mjModel::sensor_cutoff);
      row("noise", sensor, &mjModel::sensor_noise);
    }
  }

  const mjModel& composed_;
  const mjModel& alone_;
  const Placement& placement_;
  const char* kind_ = "";
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> differences(const mjModel& composed, const PlacedModel& placed) {
  return InstanceComparison(composed, placed).run();
}

}  // namespace tessera::sim
