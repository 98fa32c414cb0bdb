#include "sim/coppelia/simulator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "sim/coppelia/link_error.hpp"

namespace tessera::coppelia {
namespace {

using nlohmann::json;

constexpr std::int64_t oldest_version = 40500;  // the first with protocol version 2
constexpr Duration least_patience_for_scene = std::chrono::seconds(60);
constexpr std::size_t longest_scene_name = 900;
constexpr auto pause_between_looks = std::chrono::milliseconds(5);
constexpr std::size_t mean_intensity = 10;  ///< of the 15 numbers of a vision sensor
constexpr const char* mark_name = "tessera.run";
constexpr int short_unique_path = 1;  ///< option of sim.getObjectAlias
constexpr int depth_in_metres = 1;    ///< option of sim.getVisionSensorDepth

[[noreturn]] void unexpected(const std::string& function) {
  throw LinkError("CoppeliaSim is of an unknown version: " + function + " does not return what it should");
}

const json& at(const json& values, std::size_t index, const std::string& function) {
  if (index >= values.size()) unexpected(function);
  return values[index];
}
double number(const json& values, std::size_t index, const std::string& function) {
  const json& value = at(values, index, function);
  if (!value.is_number()) unexpected(function);
  return value.get<double>();
}
std::int64_t whole(const json& values, std::size_t index, const std::string& function) {
  return static_cast<std::int64_t>(number(values, index, function));
}
/// The array at `index` with at least `count` numbers.
const json& row(const json& values, std::size_t index, std::size_t count, const std::string& function) {
  const json& numbers = at(values, index, function);
  const bool is_row = numbers.is_array() && numbers.size() >= count &&
                      std::ranges::all_of(numbers, [](const json& one) { return one.is_number(); });
  if (!is_row) unexpected(function);
  return numbers;
}

std::string version_text(std::int64_t version) {
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

}  // namespace

template <class... Arguments>
json Simulator::call(const char* function, const Arguments&... arguments) {
  json list = json::array();
  (list.push_back(arguments), ...);
  return client_->call(function, std::move(list), server_.timeout);
}

Simulator::Simulator(const WorldServer& server)
    : server_(server), name_(server.host + ":" + std::to_string(server.port)) {
  client_.emplace(server_);
  const json info = call("zmqRemoteApi.info", "sim");
  const json& names = at(info, 0, "zmqRemoteApi.info");
  if (!names.is_object()) unexpected("zmqRemoteApi.info");
  for (const auto& [name, entry] : names.items())
    if (const auto value = entry.is_object() ? entry.find("const") : entry.end();
        entry.is_object() && value != entry.end() && value->is_number_integer())
      constants_.emplace(name, value->get<std::int64_t>());
  require_version();
}

void Simulator::connect_again(Duration patience) {
  server_.timeout = std::min(patience, server_.timeout);
  client_.emplace(server_);
}

std::int64_t Simulator::constant(const std::string& name) const {
  const auto found = constants_.find(name);
  if (found == constants_.end())
    throw LinkError("CoppeliaSim at " + name_ + " is of an unknown version: it has no constant sim." + name);
  return found->second;
}

void Simulator::require_version() {
  const std::int64_t version =
      whole(call("sim.getInt32Param", constant("intparam_program_version")), 0, "sim.getInt32Param");
  if (version < oldest_version)
    throw LinkError("CoppeliaSim at " + name_ + " has the version " + version_text(version) +
                    "; Tessera needs 4.5 or newer");
}

void Simulator::load(const std::string& scene) {
  // Longer names would be taken for the content of a file.
  if (scene.size() > longest_scene_name) throw RefusedCall("the name of the scene is too long: " + scene);
  const std::int64_t scene_of_user = scene_number();
  std::string why;
  try {
    // Other scenes stay open, so no unsaved work is lost.
    const json values = client_->call("sim.loadScene", json::array({scene + "@keepCurrent"}),
                                      std::max(server_.timeout, least_patience_for_scene));
    if (whole(values, 0, "sim.loadScene") >= 0) return;
  } catch (const RefusedCall& refused) {
    why = std::string(": ") + refused.what();
  }
  // CoppeliaSim opens an empty scene before it reads the file.
  if (scene_number() != scene_of_user) close_scene();
  throw RefusedCall("CoppeliaSim cannot load the scene " + scene + why);
}

std::int64_t Simulator::scene_number() {
  return whole(call("sim.getInt32Param", constant("intparam_scene_unique_id")), 0, "sim.getInt32Param");
}

void Simulator::require_main_script() {
  try {
    const json values = call("sim.getScript", constant("scripttype_mainscript"));
    if (whole(values, 0, "sim.getScript") >= 0) return;
  } catch (const RefusedCall&) {
  }
  throw LinkError("the scene in CoppeliaSim at " + name_ +
                  " has no main script, so its simulation cannot begin; add the default main script there");
}

void Simulator::close_scene() { static_cast<void>(call("sim.closeScene")); }

Duration Simulator::time_step() {
  const double step_s = number(call("sim.getSimulationTimeStep"), 0, "sim.getSimulationTimeStep");
  if (!(step_s >= 1e-6 && step_s < 3600)) unexpected("sim.getSimulationTimeStep");
  return std::chrono::round<Duration>(std::chrono::duration<double>(step_s));
}

bool Simulator::is_stopped() {
  return whole(call("sim.getSimulationState"), 0, "sim.getSimulationState") == constant("simulation_stopped");
}

bool Simulator::goes_on() {
  const std::int64_t state = whole(call("sim.getSimulationState"), 0, "sim.getSimulationState");
  for (const char* ending : {"simulation_stopped", "simulation_paused", "simulation_advancing_abouttostop",
                             "simulation_advancing_lastbeforestop"})
    if (state == constant(ending)) return false;
  return true;
}

void Simulator::start_stepping() {
  static_cast<void>(call("sim.setStepping", true));
  static_cast<void>(call("sim.startSimulation"));
}

void Simulator::step() { static_cast<void>(call("sim.step")); }

double Simulator::time_s() { return number(call("sim.getSimulationTime"), 0, "sim.getSimulationTime"); }

void Simulator::stop() {
  static_cast<void>(call("sim.stopSimulation"));
  const auto end = std::chrono::steady_clock::now() + server_.timeout;
  while (!is_stopped()) {
    if (std::chrono::steady_clock::now() > end)
      throw LinkError("the simulation at " + name_ + " does not stop");
    std::this_thread::sleep_for(pause_between_looks);
  }
}

/// A signal of the main script ends with the main script, whoever stops the simulation.
void Simulator::set_mark(const std::string& text) {
  const std::int64_t script =
      whole(call("sim.getScript", constant("scripttype_mainscript")), 0, "sim.getScript");
  static_cast<void>(call("sim.callScriptFunction", "sim.setStringSignal", script, mark_name, text));
}

std::string Simulator::mark() {
  const json values = call("sim.getStringSignal", mark_name);
  if (values.empty()) return {};
  if (values[0].is_binary()) return {values[0].get_binary().begin(), values[0].get_binary().end()};
  return values[0].is_string() ? values[0].get<std::string>() : std::string();
}

Object::Type Simulator::type_of(std::int64_t type) const {
  using Type = Object::Type;
  for (const auto& [name, its_type] : {std::pair{"sceneobject_joint", Type::joint},
                                       {"sceneobject_visionsensor", Type::vision_sensor},
                                       {"sceneobject_proximitysensor", Type::proximity_sensor},
                                       {"sceneobject_forcesensor", Type::force_sensor},
                                       {"sceneobject_shape", Type::shape},
                                       {"sceneobject_dummy", Type::dummy}})
    if (constant(name) == type) return its_type;
  return Type::other;
}

std::optional<Object> Simulator::find(const std::string& path) {
  const std::int64_t handle = whole(call("sim.getObject", path, json{{"noError", true}}), 0, "sim.getObject");
  if (handle < 0) return std::nullopt;
  return Object{handle, type_of(whole(call("sim.getObjectType", handle), 0, "sim.getObjectType"))};
}

std::vector<std::string> Simulator::paths(Object::Type type) {
  const json found = call("sim.getObjectsInTree", constant("handle_scene"), constant("handle_all"), 0);
  std::vector<std::string> paths;
  for (const json& handle : at(found, 0, "sim.getObjectsInTree")) {
    if (type_of(whole(call("sim.getObjectType", handle), 0, "sim.getObjectType")) != type) continue;
    const json alias = call("sim.getObjectAlias", handle, short_unique_path);
    if (at(alias, 0, "sim.getObjectAlias").is_string()) paths.push_back(alias[0].get<std::string>());
  }
  return paths;
}

double Simulator::joint_position(const Object& joint) {
  return number(call("sim.getJointPosition", joint.handle), 0, "sim.getJointPosition");
}

double Simulator::joint_velocity(const Object& joint) {
  return number(call("sim.getJointVelocity", joint.handle), 0, "sim.getJointVelocity");
}

std::array<double, 7> Simulator::pose(const Object& object) {
  const json values = call("sim.getObjectPose", object.handle, constant("handle_world"));
  const json& pose = row(values, 0, 7, "sim.getObjectPose");
  std::array<double, 7> numbers{};
  for (const auto& [to, from] : {std::pair{0, 0}, {1, 1}, {2, 2}, {3, 6}, {4, 3}, {5, 4}, {6, 5}})
    numbers.at(to) = pose[static_cast<std::size_t>(from)].get<double>();
  return numbers;
}

bool Simulator::is_handled_explicitly(const Object& sensor) {
  const auto [entry, is_new] = explicit_.try_emplace(sensor.handle, false);
  if (is_new)
    entry->second = whole(call("sim.getExplicitHandling", sensor.handle), 0, "sim.getExplicitHandling") == 1;
  return entry->second;
}

std::optional<double> Simulator::brightness(const Object& sensor) {
  const char* const function =
      is_handled_explicitly(sensor) ? "sim.handleVisionSensor" : "sim.readVisionSensor";
  const json values = call(function, sensor.handle);
  if (whole(values, 0, function) < 0) return std::nullopt;  // no picture yet
  return row(values, 1, 15, function)[mean_intensity].get<double>();
}

std::array<int, 2> Simulator::resolution(const Object& sensor) {
  const json values = call("sim.getVisionSensorRes", sensor.handle);
  const json& size = row(values, 0, 2, "sim.getVisionSensorRes");
  return {size[0].get<int>(), size[1].get<int>()};
}

Picture Simulator::picture(const char* function, const Object& sensor, int options,
                           std::size_t bytes_per_pixel) {
  if (is_handled_explicitly(sensor)) static_cast<void>(call("sim.handleVisionSensor", sensor.handle));
  json values = call(function, sensor.handle, options);
  const json& size = row(values, 1, 2, function);
  Picture picture{size[0].get<std::size_t>(), size[1].get<std::size_t>(), {}};
  json& bytes = values[0];
  if (bytes.is_binary()) picture.bytes = std::move(bytes.get_binary());
  if (picture.bytes.size() != picture.width * picture.height * bytes_per_pixel) unexpected(function);
  return picture;
}

Picture Simulator::colours(const Object& sensor) {
  return picture("sim.getVisionSensorImg", sensor, /*options=*/0, 3);
}

Picture Simulator::depths(const Object& sensor) {
  return picture("sim.getVisionSensorDepth", sensor, depth_in_metres, sizeof(float));
}

std::optional<double> Simulator::distance(const Object& sensor) {
  const char* const function =
      is_handled_explicitly(sensor) ? "sim.handleProximitySensor" : "sim.readProximitySensor";
  const json values = call(function, sensor.handle);
  const std::int64_t result = whole(values, 0, function);
  if (result < 0) return std::nullopt;
  return result == 0 ? -1 : number(values, 1, function);
}

std::optional<std::array<double, 6>> Simulator::force(const Object& sensor) {
  const json values = call("sim.readForceSensor", sensor.handle);
  if ((std::max<std::int64_t>(whole(values, 0, "sim.readForceSensor"), 0) & 1) == 0) return std::nullopt;
  std::array<double, 6> numbers{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    numbers.at(axis) = row(values, 1, 3, "sim.readForceSensor")[axis].get<double>();
    numbers.at(axis + 3) = row(values, 2, 3, "sim.readForceSensor")[axis].get<double>();
  }
  return numbers;
}

bool Simulator::collide(const Object& one, const Object& other) {
  return whole(call("sim.checkCollision", one.handle, other.handle), 0, "sim.checkCollision") > 0;
}

JointCommand Simulator::command_of(const Object& joint) {
  const std::int64_t mode = whole(call("sim.getJointMode", joint.handle), 0, "sim.getJointMode");
  if (mode == constant("jointmode_kinematic")) return JointCommand::place;
  if (mode != constant("jointmode_dynamic")) return JointCommand::none;
  const std::int64_t control =
      whole(call("sim.getObjectInt32Param", joint.handle, constant("jointintparam_dynctrlmode")), 0,
            "sim.getObjectInt32Param");
  for (const auto& [name, command] : {std::pair{"jointdynctrl_velocity", JointCommand::velocity},
                                      {"jointdynctrl_position", JointCommand::position},
                                      {"jointdynctrl_spring", JointCommand::position},
                                      {"jointdynctrl_force", JointCommand::force}})
    if (constant(name) == control) return command;
  return JointCommand::none;
}

void Simulator::command(const Object& joint, JointCommand how, double value) {
  const char* const function = how == JointCommand::velocity   ? "sim.setJointTargetVelocity"
                               : how == JointCommand::position ? "sim.setJointTargetPosition"
                               : how == JointCommand::force    ? "sim.setJointTargetForce"
                                                               : "sim.setJointPosition";
  static_cast<void>(call(function, joint.handle, value));
}

}  // namespace tessera::coppelia
