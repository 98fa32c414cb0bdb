#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/coppelia/devices.hpp"
#include "sim/coppelia/targets.hpp"
#include "sim/devices/buffer.hpp"
#include "sim/devices/options.hpp"

namespace tessera::coppelia {
namespace {

using sim::Buffer;
using sim::DeviceError;
using sim::Options;

struct Drive {
  Object joint;
  JointCommand how = JointCommand::none;
};

class Drives final : public RealEffector {
 public:
  Drives(const DeviceContext& context, Buffer buffer, std::vector<Drive> drives)
      : scene_(context.scene), buffer_(std::move(buffer)), drives_(std::move(drives)) {}

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    if (scene_ == nullptr) throw std::logic_error("a device that was only judged is used");
    const std::span<const double> numbers = buffer_.take(value);
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); })) return false;
    for (std::size_t index = 0; index < drives_.size(); ++index)
      scene_->command(drives_[index].joint, drives_[index].how, numbers[index]);
    return true;
  }

 private:
  std::shared_ptr<LockStep> scene_;
  Buffer buffer_;
  std::vector<Drive> drives_;
};

/// Without a scene, only names tell whether two joints are one: a path that begins with `/`, or the same name
/// of one agent.
std::vector<sim::Writers::Element> elements_of(const DeviceContext& context, const DriverRequest& request,
                                               const std::vector<Drive>& drives) {
  std::vector<sim::Writers::Element> elements;
  for (std::size_t index = 0; index < request.targets.size(); ++index) {
    const std::string& name = request.targets[index];
    const std::string by_name = name.starts_with('/') ? name : request.agent() + "/" + name;
    elements.push_back({context.scene == nullptr ? by_name : std::to_string(drives[index].joint.handle),
                        "joint '" + name + "'", name});
  }
  return elements;
}

/// The mode of the joint in the scene decides what its command means.
std::unique_ptr<RealEffector> actuator(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  Options(request).refuse_others();
  buffer.require_reals(request.targets.size(), request.targets.size() == 1
                                                   ? "joint '" + request.targets[0] + "' takes"
                                                   : "these joints take");
  buffer.require_si("the command of a joint");
  std::vector<Drive> drives;
  for (const Object& joint : objects_of(context, request, {Object::Type::joint})) {
    drives.push_back(
        {joint, context.scene->use([&](Simulator& simulator) { return simulator.command_of(joint); })});
    const std::string& name = request.targets[drives.size() - 1];
    if (drives.back().how == JointCommand::none)
      throw DeviceError("joint '" + name + "' has no motor that could be commanded",
                        "set its mode in the scene: dynamic with velocity, position or force control, or "
                        "kinematic",
                        name);
  }
  context.writers->claim(request, elements_of(context, request, drives));
  return std::make_unique<Drives>(context, std::move(buffer), std::move(drives));
}

}  // namespace

std::unique_ptr<RealEffector> make_effector(const DeviceContext& context, const DriverRequest& request) {
  if (request.kind == "actuator" || request.kind == "velocity") return actuator(context, request);
  throw DeviceError("worlds of CoppeliaSim have no effector '" + request.kind + "'",
                    "they have actuator, also called velocity");
}

}  // namespace tessera::coppelia
