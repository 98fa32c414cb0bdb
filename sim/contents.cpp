#include "sim/contents.hpp"

#include <nlohmann/json.hpp>

#include "sim/engine/elements.hpp"

namespace tessera::sim {
namespace {

using Json = nlohmann::ordered_json;

std::string floats(int count) { return count == 1 ? "float64" : "float64[" + std::to_string(count) + "]"; }

/// Adds every element with a name; `describe` completes its entry.
template <class Describe>
Json list(const mjModel& model, mjtObj type, Describe&& describe) {
  Json entries = Json::array();
  for (int id = 0; id < count_of(model, type); ++id) {
    const std::string name = name_of(model, type, id);
    if (name.empty() || (type == mjOBJ_BODY && id == 0)) continue;
    Json entry{{"name", name}};
    describe(id, entry);
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// The numbers of elements without a name, which no driver can refer to.
Json nameless(const mjModel& model) {
  Json counts = Json::object();
  for (const mjtObj type : {mjOBJ_SENSOR, mjOBJ_JOINT, mjOBJ_ACTUATOR, mjOBJ_SITE, mjOBJ_CAMERA})
    if (const int without = count_of(model, type) - static_cast<int>(names_of(model, type).size());
        without > 0)
      counts[word_for(type)] = without;
  return counts;
}

const char* joint_type(const mjModel& model, int joint) {
  switch (model.jnt_type[joint]) {
    case mjJNT_FREE:
      return "free";
    case mjJNT_BALL:
      return "ball";
    case mjJNT_SLIDE:
      return "slide";
    default:
      return "hinge";
  }
}

void describe_actuator(const mjModel& model, int id, Json& entry) {
  entry["kind"] = "actuator";
  entry["type"] = "float64";
  if (model.actuator_ctrllimited[id] != 0)
    entry["range"] = {model.actuator_ctrlrange[2 * id], model.actuator_ctrlrange[2 * id + 1]};
}

void describe_body(const mjModel& model, int id, Json& entry) {
  const int joint = model.body_jntadr[id];
  entry["kind"] = "pose";
  entry["label"] = id;
  entry["type"] = "float64[7]";
  entry["moved_by"] = model.body_mocapid[id] >= 0                         ? "mocap"
                      : joint >= 0 && model.jnt_type[joint] == mjJNT_FREE ? "place"
                                                                          : "";
}

}  // namespace

std::string contents_as_json(const mjModel& model) {
  Json json;
  json["timestep_s"] = model.opt.timestep;
  json["sensors"] = list(model, mjOBJ_SENSOR, [&](int id, Json& entry) {
    entry["kind"] = model.sensor_type[id] == mjSENS_USER ? "" : "sensor";
    entry["type"] = floats(model.sensor_dim[id]);
  });
  json["joints"] = list(model, mjOBJ_JOINT, [&](int id, Json& entry) {
    entry["joint"] = joint_type(model, id);
    entry["kind"] = "joint_position";
    entry["type"] = floats(position_size(model, id));
    entry["velocity_type"] = floats(velocity_size(model, id));
    if (model.jnt_limited[id] != 0) entry["range"] = {model.jnt_range[2 * id], model.jnt_range[2 * id + 1]};
  });
  json["actuators"] =
      list(model, mjOBJ_ACTUATOR, [&](int id, Json& entry) { describe_actuator(model, id, entry); });
  json["sites"] = list(model, mjOBJ_SITE, [&](int id, Json& entry) {
    // A site welded to a body moves as that body does.
    if (const int body = model.body_weldid[model.site_bodyid[id]]; body != 0)
      entry["body"] = name_of(model, mjOBJ_BODY, body);
    entry["kind"] = "scan";
    entry["type"] = "float32[N]";
  });
  json["cameras"] = list(model, mjOBJ_CAMERA, [](int, Json& entry) {
    entry["kind"] = "camera";
    entry["type"] = "uint8[9216]";
    entry["picture"] = {64, 48};
  });
  json["bodies"] = list(model, mjOBJ_BODY, [&](int id, Json& entry) { describe_body(model, id, entry); });
  json["geoms"] = list(model, mjOBJ_GEOM, [&](int, Json& entry) {
    entry["kind"] = "colour";
    entry["type"] = "float32[4]";
  });
  json["equalities"] = list(model, mjOBJ_EQUALITY, [&](int, Json& entry) {
    entry["kind"] = "weld";
    entry["type"] = "bool";
  });
  json["keyframes"] = list(model, mjOBJ_KEY, [](int, Json&) {});
  json["nameless"] = nameless(model);
  return json.dump(2);
}

}  // namespace tessera::sim
