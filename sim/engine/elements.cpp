#include "sim/engine/elements.hpp"

#include <algorithm>

namespace tessera::sim {

const char* word_for(mjtObj type) {
  switch (type) {
    case mjOBJ_SENSOR:
      return "sensor";
    case mjOBJ_JOINT:
      return "joint";
    case mjOBJ_ACTUATOR:
      return "actuator";
    case mjOBJ_SITE:
      return "site";
    case mjOBJ_CAMERA:
      return "camera";
    case mjOBJ_GEOM:
      return "geom";
    case mjOBJ_EQUALITY:
      return "equality";
    case mjOBJ_KEY:
      return "keyframe";
    default:
      return "body";
  }
}

int count_of(const mjModel& model, mjtObj type) {
  switch (type) {
    case mjOBJ_SENSOR:
      return model.nsensor;
    case mjOBJ_JOINT:
      return model.njnt;
    case mjOBJ_ACTUATOR:
      return model.nu;
    case mjOBJ_SITE:
      return model.nsite;
    case mjOBJ_CAMERA:
      return model.ncam;
    case mjOBJ_GEOM:
      return model.ngeom;
    case mjOBJ_EQUALITY:
      return model.neq;
    case mjOBJ_KEY:
      return model.nkey;
    default:
      return model.nbody;
  }
}

namespace {

std::string given_name(const mjModel& model, mjtObj type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name == nullptr ? "" : name;
}

bool moves_joint(const mjModel& model, int actuator, int joint) {
  const int how = model.actuator_trntype[actuator];
  return (how == mjTRN_JOINT || how == mjTRN_JOINTINPARENT) && model.actuator_trnid[2 * actuator] == joint;
}

/// Empty if the name could also mean another actuator.
std::string name_by_joint(const mjModel& model, int actuator) {
  const int joint = model.actuator_trnid[2 * actuator];
  if (!moves_joint(model, actuator, joint)) return {};
  std::string name = given_name(model, mjOBJ_JOINT, joint);
  for (int other = 0; other < model.nu; ++other) {
    const bool same = moves_joint(model, other, joint) || given_name(model, mjOBJ_ACTUATOR, other) == name;
    if (other != actuator && same) return {};
  }
  return name;
}

/// Looks up the full name.
std::optional<int> find_exactly(const mjModel& model, mjtObj type, const std::string& name) {
  if (const int id = mj_name2id(&model, type, name.c_str()); id >= 0) return id;
  if (type != mjOBJ_ACTUATOR || name.empty()) return std::nullopt;
  for (int id = 0; id < model.nu; ++id)
    if (name_of(model, type, id) == name) return id;
  return std::nullopt;
}

}  // namespace

std::string name_of(const mjModel& model, mjtObj type, int id) {
  std::string name = given_name(model, type, id);
  return name.empty() && type == mjOBJ_ACTUATOR ? name_by_joint(model, id) : name;
}

std::vector<std::string> names_of(const mjModel& model, mjtObj type) {
  std::vector<std::string> all;
  for (int id = 0; id < count_of(model, type); ++id)
    if (std::string name = name_of(model, type, id); !name.empty()) all.push_back(std::move(name));
  return all;
}

std::optional<int> find_element(const mjModel& model, mjtObj type, std::string_view agent,
                                const std::string& name) {
  if (name.starts_with('/')) return find_exactly(model, type, name.substr(1));
  if (const auto own = find_exactly(model, type, std::string(agent) + "/" + name)) return own;
  return find_exactly(model, type, name);
}

std::vector<std::string> names_for(const mjModel& model, mjtObj type, std::string_view agent) {
  const std::string own = std::string(agent) + "/";
  std::vector<std::string> names;
  for (const std::string& name : names_of(model, type))
    names.push_back(name.starts_with(own) ? name.substr(own.size()) : name);
  const auto rank = [&](const std::string& name) { return name.find('/') == std::string::npos ? 0 : 1; };
  std::ranges::stable_sort(names, {}, rank);
  return names;
}

int position_size(const mjModel& model, int joint) {
  return model.jnt_type[joint] == mjJNT_FREE ? 7 : model.jnt_type[joint] == mjJNT_BALL ? 4 : 1;
}

int velocity_size(const mjModel& model, int joint) {
  return model.jnt_type[joint] == mjJNT_FREE ? 6 : model.jnt_type[joint] == mjJNT_BALL ? 3 : 1;
}

}  // namespace tessera::sim
