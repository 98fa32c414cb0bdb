#include "sim/coppelia/view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace tessera::coppelia {
namespace {

class ViewOfScene final : public WorldState {
 private:
  /// The result of `act`. Any exception becomes a WorldError.
  template <class Act>
  static auto guarded(Act&& act) try {
    return act();
  } catch (const std::exception& error) {
    throw WorldError(error.what());
  }
  [[nodiscard]] Object find(const std::string& name) const {
    const auto object = guarded([&] { return scene_->find(agent_, name); });
    if (!object) throw WorldError("the world has no object '" + name + "'");
    return *object;
  }
  template <class Ask>
  [[nodiscard]] auto ask(const std::string& name, Ask&& ask) const {
    const Object object = find(name);
    return guarded([&] { return scene_->use([&](Simulator& simulator) { return ask(simulator, object); }); });
  }
  static std::vector<double> numbers_of(Simulator& simulator, const Object& one, const std::string& name) {
    if (one.type == Object::Type::force_sensor) {
      if (const auto force = simulator.force(one)) return {force->begin(), force->end()};
    } else if (one.type == Object::Type::proximity_sensor) {
      if (const auto distance_m = simulator.distance(one)) return {*distance_m};
    } else if (one.type == Object::Type::vision_sensor) {
      if (const auto brightness = simulator.brightness(one)) return {*brightness};
    } else {
      throw WorldError("'" + name + "' is no sensor");
    }
    throw WorldError("the sensor '" + name + "' has no value yet");
  }

 public:
  ViewOfScene(std::shared_ptr<LockStep> scene, std::string agent)
      : scene_(std::move(scene)), agent_(std::move(agent)) {}

  [[nodiscard]] Duration time() const override { return scene_->time(); }
  [[nodiscard]] Pose body(const std::string& name) const override {
    const auto numbers =
        ask(name, [](Simulator& simulator, const Object& one) { return simulator.pose(one); });
    Pose pose;
    std::copy_n(numbers.begin(), 3, pose.position_m.begin());
    std::copy_n(numbers.begin() + 3, 4, pose.quaternion.begin());
    return pose;
  }
  [[nodiscard]] Pose site(const std::string& name) const override { return body(name); }
  [[nodiscard]] std::vector<double> sensor(const std::string& name) const override {
    return ask(name,
               [&](Simulator& simulator, const Object& one) { return numbers_of(simulator, one, name); });
  }
  [[nodiscard]] std::vector<double> joint_position(const std::string& name) const override {
    return ask(name, [](Simulator& simulator, const Object& one) {
      return std::vector{simulator.joint_position(one)};
    });
  }
  [[nodiscard]] std::vector<double> joint_velocity(const std::string& name) const override {
    return ask(name, [](Simulator& simulator, const Object& one) {
      return std::vector{simulator.joint_velocity(one)};
    });
  }
  [[nodiscard]] bool touch(const std::string& body, const std::string& other) const override {
    const Object second = find(other);
    return ask(body, [&](Simulator& simulator, const Object& one) { return simulator.collide(one, second); });
  }
  void command(const std::string& actuator, double value) override {
    if (!std::isfinite(value)) throw WorldError("the command of '" + actuator + "' is no finite number");
    const JointCommand how =
        ask(actuator, [](Simulator& simulator, const Object& one) { return simulator.command_of(one); });
    if (how == JointCommand::none)
      throw WorldError("joint '" + actuator + "' has no motor that could be commanded");
    guarded([&] { scene_->command(find(actuator), how, value); });
  }
  void push(const std::string& /*body*/, const std::array<double, 3>& /*force_n*/) override {
    throw WorldError("worlds of CoppeliaSim take no forces on bodies");
  }

 private:
  std::shared_ptr<LockStep> scene_;
  std::string agent_;
};

}  // namespace

std::shared_ptr<WorldState> view_of(std::shared_ptr<LockStep> scene, std::string agent) {
  return std::make_shared<ViewOfScene>(std::move(scene), std::move(agent));
}

}  // namespace tessera::coppelia
