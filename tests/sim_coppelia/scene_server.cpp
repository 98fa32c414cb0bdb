#include "scene_server.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace tessera::testing {
namespace {

using nlohmann::json;

constexpr double wheel_radius_m = 0.03, wheel_distance_m = 0.16, eye_footprint_m = 0.008;
constexpr int first_handle = 10, main_script = 1000000;
constexpr int advancing = 16, paused = 8;

// The numbers are CoppeliaSim's. A client must take them from zmqRemoteApi.info, so some are others here.
const json constants{{"intparam_program_version", 1007},
                     {"intparam_scene_unique_id", 1020},
                     {"simulation_stopped", 0},
                     {"simulation_paused", 8},
                     {"simulation_advancing_abouttostop", 21},
                     {"simulation_advancing_lastbeforestop", 22},
                     {"handle_scene", -11},
                     {"scripttype_mainscript", 7},
                     {"handle_all", -2},
                     {"handle_world", -1},
                     {"sceneobject_shape", 100},
                     {"sceneobject_joint", 101},
                     {"sceneobject_dummy", 104},
                     {"sceneobject_proximitysensor", 105},
                     {"sceneobject_visionsensor", 109},
                     {"sceneobject_forcesensor", 112},
                     {"jointmode_kinematic", 200},
                     {"jointmode_dynamic", 205},
                     {"jointintparam_dynctrlmode", 2040},
                     {"jointdynctrl_free", 300},
                     {"jointdynctrl_force", 301},
                     {"jointdynctrl_velocity", 304},
                     {"jointdynctrl_position", 308},
                     {"jointdynctrl_spring", 312}};
int constant(const char* name) { return constants.at(name).get<int>(); }

/// As the server of CoppeliaSim words it.
[[noreturn]] void refuse(const std::string& function, const std::string& why) {
  throw std::runtime_error("1189: in " + function + ": " + why +
                           "_=NL=_stack traceback:_=NL=__=TB=_[C]: in ?");
}

json info() {
  json names = json::object();
  for (const auto& [name, value] : constants.items()) names[name] = {{"const", value}};
  names["step"] = {{"func", json::object()}};
  return json::array({names});
}

json row(std::initializer_list<double> numbers) { return json(numbers); }

}  // namespace

SceneServer::SceneServer(Settings settings)
    : settings_(std::move(settings)),
      robot_(settings_.start),
      state_(settings_.runs_already ? advancing : 0) {
  if (!settings_.track.empty()) {
    auto track = sim::Track::load(settings_.track, 0.005);
    if (!track) throw std::runtime_error(track.problem());
    floor_ = std::move(*track);
  }
  const int joint = constant("sceneobject_joint"), vision = constant("sceneobject_visionsensor"),
            dynamic = constant("jointmode_dynamic");
  const auto motor = [&](const char* path, const char* control) {
    things_.push_back({.path = path, .type = joint, .mode = dynamic, .control = constant(control)});
  };
  const auto eye = [&](const char* path, double y_m) {
    things_.push_back({.path = path, .type = vision, .at = {0.1, y_m}});
  };
  things_.push_back({.path = "/robot", .type = constant("sceneobject_shape")});
  motor("/robot/wheel_left", "jointdynctrl_velocity");
  motor("/robot/wheel_right", "jointdynctrl_velocity");
  eye("/robot/eye_left", 0.02);
  eye("/robot/eye_middle", 0);
  eye("/robot/eye_right", -0.02);
  motor("/arm/servo", "jointdynctrl_position");
  motor("/arm/torque", "jointdynctrl_force");
  motor("/arm/free", "jointdynctrl_free");
  things_.push_back({.path = "/arm/slide", .type = joint, .mode = constant("jointmode_kinematic")});
  things_.push_back({.path = "/camera", .type = vision, .is_explicit = true});
  things_.push_back({.path = "/bumper", .type = constant("sceneobject_proximitysensor")});
  things_.push_back({.path = "/wrist", .type = constant("sceneobject_forcesensor")});
  things_.push_back({.path = "/goal", .type = constant("sceneobject_dummy")});
  server_ =
      std::make_unique<ReplyServer>([this](const Bytes& request) { return answer(request); }, settings_.port);
}

WorldServer SceneServer::address() const {
  return {"127.0.0.1", server_->port(), "", std::chrono::seconds(2)};
}

std::optional<Bytes> SceneServer::answer(const Bytes& request) {
  const std::scoped_lock lock(mutex_);
  const json asked = json::from_cbor(request);
  const std::string function = asked.at("func").get<std::string>();
  calls_.push_back(function);
  if (settings_.silent.contains(function)) return std::nullopt;
  if (function == settings_.late)
    std::this_thread::sleep_for(std::exchange(settings_.lateness, std::chrono::milliseconds(0)));
  const json wait{{"func", "_*wait*_"}, {"args", json::object()}};
  if (function == "_*end*_") return json::to_cbor(json::object());
  if (function == "sim.step") waits_left_ = settings_.waits_per_step;
  if (function == "sim.step" || function == "_*executed*_") {
    if (waits_left_-- > 0) return json::to_cbor(wait);
    if (state_ == advancing) step();
    return json::to_cbor({{"ret", json::object()}});
  }
  try {
    json returned = execute(function, asked.at("args"));
    return json::to_cbor({{"ret", returned.empty() ? json::object() : returned}});
  } catch (const std::runtime_error& error) {
    return json::to_cbor({{"err", error.what()}});
  }
}

json SceneServer::execute(const std::string& function, const json& arguments) {
  for (const auto part : {&SceneServer::of_scenes, &SceneServer::of_simulation, &SceneServer::of_object,
                          &SceneServer::of_joint, &SceneServer::of_sensor})
    if (json values = (this->*part)(function, arguments); !values.is_null()) return values;
  throw std::runtime_error("No such function: " + function);
}

json SceneServer::of_scenes(const std::string& function, const json& arguments) {
  if (function == "sim.getInt32Param") {
    const bool number = arguments.at(0) == constant("intparam_scene_unique_id");
    return json::array({number ? scenes_.back().number : settings_.version});
  }
  if (function == "sim.loadScene") {
    const std::string scene = arguments.at(0).get<std::string>();
    const std::size_t option = scene.find("@keepCurrent");
    if (option == std::string::npos) refuse(function, "the test wants the open scene to stay");
    // The real one does so, too, before it reads the file.
    scenes_.push_back({++last_scene_, /*is_empty=*/true});
    if (!scene.substr(0, option).ends_with(".ttt")) refuse(function, "file could not be read");
    scenes_.back().is_empty = false;
    return json::array({1});
  }
  if (function == "sim.closeScene") {
    scenes_.pop_back();
    if (scenes_.empty()) scenes_.push_back({++last_scene_, /*is_empty=*/true});
    return json::array({1});
  }
  return nullptr;
}

json SceneServer::of_simulation(const std::string& function, const json& arguments) {
  if (function == "zmqRemoteApi.info") return json::array({info()[0]});
  if (function == "sim.getSimulationState") return json::array({state_});
  if (function == "sim.getSimulationTimeStep") return json::array({settings_.step_s});
  if (function == "sim.getSimulationTime") return json::array({time_s_});
  if (function == "sim.setStepping") return is_stepping_ = arguments.at(0).get<bool>(), json::array({0});
  if (function == "sim.startSimulation") {
    if (!is_stepping_) refuse(function, "the test wants lock-step");
    return state_ = advancing, json::array({1});
  }
  if (function == "sim.stopSimulation") {
    end();
    return json::array();
  }
  if (function == "sim.getScript") {
    if (arguments.at(0) != constant("scripttype_mainscript") || settings_.no_main_script)
      refuse(function, "script does not exist.");
    return json::array({main_script});
  }
  if (function == "sim.callScriptFunction") {
    if (settings_.no_marks || time_s_ == 0 || arguments.at(1) != main_script ||
        arguments.at(0) != "sim.setStringSignal")
      refuse(function, "failed calling script function.");
    signals_[arguments.at(2).get<std::string>()] = arguments.at(3).get<std::string>();
    return json::array({1});
  }
  if (function == "sim.getStringSignal") {
    const auto found = signals_.find(arguments.at(0).get<std::string>());
    if (found == signals_.end()) return json::array();
    return json::array({json::binary({found->second.begin(), found->second.end()})});
  }
  return nullptr;
}

SceneServer::Thing& SceneServer::thing(const json& handle) {
  const auto index = static_cast<std::size_t>(handle.get<int>() - first_handle);
  if (index >= things_.size()) refuse("sim.getObject", "object does not exist");
  return things_[index];
}

json SceneServer::of_object(const std::string& function, const json& arguments) {
  if (function == "sim.getObject") {
    const auto found = std::ranges::find(things_, arguments.at(0).get<std::string>(), &Thing::path);
    return json::array({scenes_.back().is_empty || found == things_.end()
                            ? -1
                            : static_cast<int>(found - things_.begin()) + first_handle});
  }
  if (function == "sim.getObjectsInTree") {
    json handles = json::array();
    for (std::size_t index = 0; index < things_.size(); ++index) handles.push_back(index + first_handle);
    return json::array({handles});
  }
  if (function == "sim.getObjectType") return json::array({thing(arguments.at(0)).type});
  if (function == "sim.getObjectAlias") return json::array({thing(arguments.at(0)).path});
  if (function == "sim.getObjectPose") {
    const double half = robot_.heading_rad / 2;
    return json::array({row({robot_.at.x_m, robot_.at.y_m, 0.03, 0, 0, std::sin(half), std::cos(half)})});
  }
  if (function == "sim.checkCollision") return json::array({1, row({10, 11})});
  return nullptr;
}

json SceneServer::of_joint(const std::string& function, const json& arguments) {
  if (function == "sim.getJointMode") return json::array({thing(arguments.at(0)).mode, 0});
  if (function == "sim.getObjectInt32Param") return json::array({thing(arguments.at(0)).control});
  if (function == "sim.getJointPosition") return json::array({thing(arguments.at(0)).position});
  if (function == "sim.getJointVelocity") return json::array({thing(arguments.at(0)).velocity});
  const auto set = [&](int control, const char* mode) {
    Thing& joint = thing(arguments.at(0));
    if (joint.mode != constant(mode) || (control != 0 && joint.control != control))
      refuse(function, "the joint has another mode");
    joint.target = arguments.at(1).get<double>();
    return json::array({1});
  };
  if (function == "sim.setJointTargetVelocity")
    return set(constant("jointdynctrl_velocity"), "jointmode_dynamic");
  if (function == "sim.setJointTargetPosition")
    return set(constant("jointdynctrl_position"), "jointmode_dynamic");
  if (function == "sim.setJointTargetForce") return set(constant("jointdynctrl_force"), "jointmode_dynamic");
  if (function == "sim.setJointPosition") return set(0, "jointmode_kinematic");
  return nullptr;
}

json SceneServer::of_sensor(const std::string& function, const json& arguments) {
  if (function == "sim.getExplicitHandling") return json::array({thing(arguments.at(0)).is_explicit ? 1 : 0});
  if (function == "sim.readVisionSensor" || function == "sim.handleVisionSensor") {
    const Thing& eye = thing(arguments.at(0));
    if (eye.is_explicit != (function == "sim.handleVisionSensor")) refuse(function, "explicit handling");
    if (time_s_ == 0 && !eye.is_explicit) return json::array({-1});
    json numbers = json::array();
    for (int index = 0; index < 15; ++index) numbers.push_back(index == 10 ? brightness(eye) : -1.0);
    return json::array({0, numbers, json::object()});
  }
  if (function == "sim.getVisionSensorRes") return json::array({row({4, 3})});
  if (function == "sim.getVisionSensorImg") {
    std::vector<std::uint8_t> rgb(36);
    for (std::size_t index = 0; index < rgb.size(); ++index) rgb[index] = static_cast<std::uint8_t>(index);
    return json::array({json::binary(rgb), row({4, 3})});
  }
  if (function == "sim.getVisionSensorDepth") {
    if (arguments.at(1) != 1) refuse(function, "the test wants metres");
    std::vector<std::uint8_t> bytes;
    for (int index = 0; index < 12; ++index) {
      const float depth_m = 0.5F * static_cast<float>(index);
      std::array<std::uint8_t, sizeof depth_m> one{};
      std::memcpy(one.data(), &depth_m, sizeof depth_m);
      bytes.insert(bytes.end(), one.begin(), one.end());
    }
    return json::array({json::binary(bytes), row({4, 3})});
  }
  if (function == "sim.readProximitySensor") {
    if (time_s_ == 0) return json::array({0, 0.0, row({0, 0, 0}), -1, row({0, 0, 0})});
    const bool near = time_s_ < 0.1;  // it detects an object only then
    return json::array({near ? 1 : 0, near ? 0.25 : 0.0, row({0, 0, 0.25}), 10, row({0, 0, 1})});
  }
  if (function == "sim.readForceSensor")
    return json::array({time_s_ == 0 ? 0 : 1, row({1, 2, 3}), row({4, 5, 6})});
  return nullptr;
}

sim::Point SceneServer::eye_at(const Thing& eye) const {
  const double c = std::cos(robot_.heading_rad), s = std::sin(robot_.heading_rad);
  return {robot_.at.x_m + c * eye.at[0] - s * eye.at[1], robot_.at.y_m + s * eye.at[0] + c * eye.at[1]};
}

double SceneServer::brightness(const Thing& eye) const {
  return floor_ ? floor_->reflectance(eye_at(eye), eye_footprint_m) : 1;
}

void SceneServer::step() {
  time_s_ += settings_.step_s;
  for (Thing& one : things_) {
    if (one.type != constant("sceneobject_joint")) continue;
    if (one.control == constant("jointdynctrl_velocity")) {
      one.velocity = one.target;
      one.position += one.velocity * settings_.step_s;
    } else if (one.control != constant("jointdynctrl_force")) {
      one.position = one.target;
    }
  }
  const double left = things_[1].velocity * wheel_radius_m, right = things_[2].velocity * wheel_radius_m;
  const double turned_rad = (right - left) / wheel_distance_m * settings_.step_s;
  const double way_m = (left + right) / 2 * settings_.step_s;
  robot_.at.x_m += way_m * std::cos(robot_.heading_rad + turned_rad / 2);
  robot_.at.y_m += way_m * std::sin(robot_.heading_rad + turned_rad / 2);
  robot_.heading_rad += turned_rad;
  const sim::Point middle = eye_at(things_[4]);
  const bool on_line =
      brightness(things_[3]) < 0.5 || brightness(things_[4]) < 0.5 || brightness(things_[5]) < 0.5;
  trace_.points.push_back({.t_s = time_s_,
                           .x_m = robot_.at.x_m,
                           .y_m = robot_.at.y_m,
                           .heading_rad = robot_.heading_rad,
                           .eye_x_m = middle.x_m,
                           .eye_y_m = middle.y_m,
                           .on_line = on_line});
}

sim::Trace SceneServer::trace() const {
  const std::scoped_lock lock(mutex_);
  return trace_;
}
std::vector<int> SceneServer::scenes() const {
  const std::scoped_lock lock(mutex_);
  std::vector<int> numbers;
  for (const OpenScene& one : scenes_) numbers.push_back(one.number);
  return numbers;
}

bool SceneServer::is_running() const {
  const std::scoped_lock lock(mutex_);
  return state_ != 0;
}
std::vector<std::string> SceneServer::calls() const {
  const std::scoped_lock lock(mutex_);
  return calls_;
}
double SceneServer::joint(const std::string& path) const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::find(things_, path, &Thing::path)->target;
}
void SceneServer::step_by_itself() {
  const std::scoped_lock lock(mutex_);
  step();
}
/// The main script takes its signals with it.
void SceneServer::end() {
  state_ = 0;
  time_s_ = 0;
  is_stepping_ = false;
  signals_.clear();
}

void SceneServer::stop_by_hand() {
  const std::scoped_lock lock(mutex_);
  end();
}
void SceneServer::run_by_hand(const std::map<std::string, std::string>& signals) {
  const std::scoped_lock lock(mutex_);
  state_ = advancing;
  signals_ = signals;
}
std::map<std::string, std::string> SceneServer::signals() const {
  const std::scoped_lock lock(mutex_);
  return signals_;
}
void SceneServer::begin_to_stop_by_hand() {
  const std::scoped_lock lock(mutex_);
  state_ = constant("simulation_advancing_abouttostop");
  for (int steps = 0; steps < 3; ++steps) step();
}
void SceneServer::pause() {
  const std::scoped_lock lock(mutex_);
  state_ = paused;
}

}  // namespace tessera::testing
