#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "sim/engine/elements.hpp"
#include "sim/scene/scene.hpp"

namespace tessera::sim {
namespace {

[[nodiscard]] std::optional<int> body_of_actuator(const mjModel& model, int actuator) {
  const int target = model.actuator_trnid[2 * actuator];
  if (target < 0) return std::nullopt;
  switch (model.actuator_trntype[actuator]) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      return model.jnt_bodyid[target];
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
      return model.site_bodyid[target];
    case mjTRN_BODY:
      return target;
    default:
      return std::nullopt;
  }
}

[[nodiscard]] std::optional<int> body_of(const mjModel& model, int type, int id) {
  switch (type) {
    case mjOBJ_BODY:
    case mjOBJ_XBODY:
      return id;
    case mjOBJ_JOINT:
      return model.jnt_bodyid[id];
    case mjOBJ_GEOM:
      return model.geom_bodyid[id];
    case mjOBJ_SITE:
      return model.site_bodyid[id];
    case mjOBJ_CAMERA:
      return model.cam_bodyid[id];
    case mjOBJ_ACTUATOR:
      return body_of_actuator(model, id);
    case mjOBJ_SENSOR:
      if (model.sensor_objtype[id] == mjOBJ_SENSOR || model.sensor_objid[id] < 0) return std::nullopt;
      return body_of(model, model.sensor_objtype[id], model.sensor_objid[id]);
    default:
      return std::nullopt;
  }
}

/// The body of a device's first target. Elements of the robot itself are looked up first.
[[nodiscard]] std::optional<int> body_of_device(const mjModel& model, const DriverRequest& device) {
  constexpr std::array types{mjOBJ_SITE,   mjOBJ_ACTUATOR, mjOBJ_SENSOR, mjOBJ_JOINT,
                             mjOBJ_CAMERA, mjOBJ_BODY,     mjOBJ_GEOM};
  for (const std::string& target : device.targets)
    for (const mjtObj type : types)
      if (const auto id = find_element(model, type, device.agent(), target))
        if (const std::optional<int> body = body_of(model, type, *id); body && *body > 0) return body;
  return std::nullopt;
}

[[nodiscard]] std::string only_one(const std::set<std::string>& agents) {
  return agents.size() == 1 ? *agents.begin() : std::string();
}

}  // namespace

std::vector<std::string> agents_of_bodies(const mjModel& model, std::span<const int> bodies,
                                          std::span<const DriverRequest> devices) {
  std::set<std::string> agents;
  std::map<int, std::set<std::string>> at_body, at_root;
  for (const DriverRequest& device : devices) {
    agents.insert(device.agent());
    const std::optional<int> body = body_of_device(model, device);
    if (!body) continue;
    at_body[*body].insert(device.agent());
    at_root[model.body_rootid[*body]].insert(device.agent());
  }
  std::vector<std::string> owners;
  for (const int body : bodies) {
    const std::string name = body_name(model, body);
    const std::string prefix = name.substr(0, name.find('/'));
    if (prefix.size() < name.size() && agents.contains(prefix)) {
      owners.push_back(prefix);
      continue;
    }
    // The nearest device on the way to the world counts first, then any device of the same robot.
    std::string owner;
    for (int above = body; above != 0 && owner.empty(); above = model.body_parentid[above])
      if (const auto found = at_body.find(above); found != at_body.end()) owner = only_one(found->second);
    const auto root = at_root.find(model.body_rootid[body]);
    if (owner.empty() && root != at_root.end()) owner = only_one(root->second);
    owners.push_back(owner);
  }
  return owners;
}

}  // namespace tessera::sim
