#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "sim/devices.hpp"
#include "sim/names.hpp"
#include "sim/simulation.hpp"
#include "tessera/device.hpp"

namespace tessera::sim {
namespace {

/// The result of `make`; nullptr, and the reason in `error`, if it throws.
template <class Make>
auto without_exceptions(Make&& make, std::string& error) -> decltype(make()) try {
  return make();
} catch (const std::exception& thrown) {
  error = thrown.what();
  return nullptr;
} catch (...) {
  error = "the simulated world failed without saying why";
  return nullptr;
}

class MujocoWorld final : public World {
 public:
  MujocoWorld(std::shared_ptr<Simulation> simulation, double footprint_m, std::uint64_t seed)
      : simulation_(std::move(simulation)), footprint_m_(footprint_m), seed_(seed) {}

  [[nodiscard]] std::unique_ptr<RealReceptor> receptor(const DriverRequest& request,
                                                       std::string& error) override {
    if (request.kind == "reflectance") {
      return prefixed(
          request,
          without_exceptions([&] { return light_sensor(simulation_, request, footprint_m_, seed_, error); },
                             error),
          error);
    }
    error = request.path + ": " + unknown_name("receptor", request.kind, {"reflectance"});
    return nullptr;
  }

  [[nodiscard]] std::unique_ptr<RealEffector> effector(const DriverRequest& request,
                                                       std::string& error) override {
    if (request.kind == "velocity")
      return prefixed(request, without_exceptions([&] { return wheel(simulation_, request, error); }, error),
                      error);
    error = request.path + ": " + unknown_name("effector", request.kind, {"velocity"});
    return nullptr;
  }

  void advance_to(Time time) override { simulation_->advance_to(time); }
  [[nodiscard]] bool finish(std::string& error) override { return simulation_->finish(error); }

 private:
  template <class Device>
  static Device prefixed(const DriverRequest& request, Device device, std::string& error) {
    if (!device) error = request.path + ": " + error;
    return device;
  }

  std::shared_ptr<Simulation> simulation_;  // devices may outlive the world
  double footprint_m_;
  std::uint64_t seed_;
};

bool place(Physics& physics, const WorldOptions& options, std::string& error) {
  if (!options.start_x_m && !options.start_y_m && !options.start_heading_rad) return true;
  auto pose = physics.robot();
  if (!pose) {
    error = options.world + ": a start pose needs a body with a free joint";
    return false;
  }
  *pose = {{options.start_x_m.value_or(pose->at.x_m), options.start_y_m.value_or(pose->at.y_m)},
           options.start_heading_rad.value_or(pose->heading_rad)};
  if (!std::isfinite(pose->at.x_m) || !std::isfinite(pose->at.y_m) || !std::isfinite(pose->heading_rad)) {
    error = "the start pose must be finite numbers";
    return false;
  }
  physics.place_robot(*pose);
  return true;
}

std::unique_ptr<World> open(const WorldOptions& options, std::string& error) {
  if (!std::isfinite(options.footprint_m) || options.footprint_m < 0) {
    error = "the footprint must be a number from 0 up";
    return nullptr;
  }
  auto physics = Physics::load(options.world, error);
  if (!physics || !place(*physics, options, error)) return nullptr;
  std::optional<Track> floor;
  if (!options.track.empty()) {
    floor = Track::load(options.track, options.metres_per_pixel, error);
    if (!floor) return nullptr;
  }
  auto simulation = std::make_shared<Simulation>(std::move(physics), std::move(floor), options.trace);
  return std::make_unique<MujocoWorld>(std::move(simulation), options.footprint_m, options.seed);
}

}  // namespace
}  // namespace tessera::sim

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

/// Opens a MuJoCo world; throws nothing. See tessera::OpenWorld. Kinds: receptor `reflectance` (target: a
/// site), effector `velocity` (target: an actuator).
extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::World> tessera_open_world(
    const tessera::WorldOptions& options, std::string& error) {
  return tessera::sim::without_exceptions([&] { return tessera::sim::open(options, error); }, error);
}
