#include "sim/coppelia/contents.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "sim/coppelia/lock_step.hpp"

namespace tessera::coppelia {
namespace {

using Json = nlohmann::ordered_json;
using Type = Object::Type;

/// Adds an entry for every object of a type; `describe` completes it, or returns false to leave it out.
template <class Describe>
void add(Simulator& simulator, Json& entries, Type type, Describe&& describe) {
  for (const std::string& path : simulator.paths(type)) {
    const auto object = simulator.find(path);
    Json entry{{"name", path}};
    if (object && describe(*object, entry)) entries.push_back(std::move(entry));
  }
}

auto with(const char* kind, const char* type) {
  return [kind, type](const Object&, Json& entry) {
    entry["kind"] = kind;
    entry["type"] = type;
    return true;
  };
}

const char* word_for(JointCommand how) {
  switch (how) {
    case JointCommand::velocity:
      return "velocity";
    case JointCommand::position:
      return "position";
    case JointCommand::force:
      return "force";
    default:
      return "kinematic";
  }
}

bool describe_camera(Simulator& simulator, const Object& sensor, Json& entry) {
  const auto [width, height] = simulator.resolution(sensor);
  entry["kind"] = "camera";
  entry["type"] = "uint8[" + std::to_string(3 * width * height) + "]";
  entry["picture"] = {width, height};
  return true;
}

bool describe_actuator(Simulator& simulator, const Object& joint, Json& entry) {
  const JointCommand how = simulator.command_of(joint);
  entry["kind"] = "actuator";
  entry["type"] = "float64";
  entry["joint"] = word_for(how);
  return how != JointCommand::none;
}

Json contents(Simulator& simulator) {
  Json json;
  json["timestep_s"] = seconds(simulator.time_step());
  for (const char* list :
       {"sensors", "joints", "actuators", "sites", "cameras", "bodies", "geoms", "equalities", "keyframes"})
    json[list] = Json::array();
  json["nameless"] = Json::object();
  add(simulator, json["sensors"], Type::proximity_sensor, with("sensor", "float64"));
  add(simulator, json["sensors"], Type::force_sensor, with("sensor", "float64[6]"));
  add(simulator, json["joints"], Type::joint, [](const Object&, Json& entry) {
    entry["kind"] = "joint_position";
    entry["type"] = "float64";
    entry["velocity_type"] = "float64";
    return true;
  });
  add(simulator, json["actuators"], Type::joint,
      [&](const Object& joint, Json& entry) { return describe_actuator(simulator, joint, entry); });
  add(simulator, json["cameras"], Type::vision_sensor,
      [&](const Object& sensor, Json& entry) { return describe_camera(simulator, sensor, entry); });
  for (const Type type : {Type::shape, Type::dummy})
    add(simulator, json["bodies"], type, with("pose", "float64[7]"));
  return json;
}

}  // namespace

std::string contents_as_json(const WorldServer& server) {
  LockStep scene(server);
  return scene.use([](Simulator& simulator) {
    return contents(simulator).dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
  });
}

}  // namespace tessera::coppelia
