#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "sim/devices.hpp"
#include "sim/simulation.hpp"
#include "sim/unknown_name.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {
namespace {

/// What `make` returns, or the problem that it throws.
template <class Make>
auto without_exceptions(Make&& make) -> decltype(make()) try {
  return make();
} catch (const std::exception& thrown) {
  return Problem{thrown.what()};
} catch (...) {
  return Problem{"the simulated world failed without saying why"};
}

/// As the interface of worlds has it: nullptr and `error`.
template <class T>
std::unique_ptr<T> value_or_null(Result<std::unique_ptr<T>> made, std::string& error) {
  if (made) return std::move(*made);
  error = made.problem();
  return nullptr;
}

/// The device that `make` returns; nullptr, and in `error` the path and the reason.
template <class Make>
auto device_or_null(const DriverRequest& request, Make&& make, std::string& error) {
  auto made = value_or_null(without_exceptions(std::forward<Make>(make)), error);
  if (!made) error.insert(0, request.path + ": ");
  return made;
}

class MujocoWorld final : public World {
 public:
  MujocoWorld(std::shared_ptr<Simulation> simulation, double footprint_m, std::uint64_t seed)
      : simulation_(std::move(simulation)), footprint_m_(footprint_m), seed_(seed) {}

  [[nodiscard]] std::unique_ptr<RealReceptor> receptor(const DriverRequest& request,
                                                       std::string& error) override {
    return device_or_null(
        request, [&] { return make_receptor(request); }, error);
  }

  [[nodiscard]] std::unique_ptr<RealEffector> effector(const DriverRequest& request,
                                                       std::string& error) override {
    return device_or_null(
        request, [&] { return make_effector(request); }, error);
  }

  void advance_to(Time time) override { simulation_->advance_to(time); }
  [[nodiscard]] std::optional<WorldScene> scene(std::span<const DriverRequest> devices) override {
    return simulation_->scene(devices);
  }
  void show_poses(PoseSink& sink) override { simulation_->show_poses(sink); }
  [[nodiscard]] bool finish(std::string& error) override {
    const std::optional<Problem> problem = simulation_->finish();
    if (problem) error = problem->text;
    return !problem;
  }

 private:
  [[nodiscard]] Result<std::unique_ptr<RealReceptor>> make_receptor(const DriverRequest& request) {
    if (request.kind == "reflectance") return light_sensor(simulation_, request, footprint_m_, seed_);
    return Problem{unknown_name("receptor", request.kind, {"reflectance"})};
  }
  [[nodiscard]] Result<std::unique_ptr<RealEffector>> make_effector(const DriverRequest& request) {
    if (request.kind == "velocity") return wheel(simulation_, request);
    return Problem{unknown_name("effector", request.kind, {"velocity"})};
  }
  std::shared_ptr<Simulation> simulation_;  // devices may outlive the world
  double footprint_m_;
  std::uint64_t seed_;
};

std::optional<Problem> put_robot_at_start(Physics& physics, const WorldOptions& options) {
  if (!options.start_x_m && !options.start_y_m && !options.start_heading_rad) return std::nullopt;
  auto pose = physics.robot();
  if (!pose) return Problem{options.world + ": a start pose needs a body with a free joint"};
  *pose = {{options.start_x_m.value_or(pose->at.x_m), options.start_y_m.value_or(pose->at.y_m)},
           options.start_heading_rad.value_or(pose->heading_rad)};
  if (!std::isfinite(pose->at.x_m) || !std::isfinite(pose->at.y_m) || !std::isfinite(pose->heading_rad))
    return Problem{"the start pose must be finite numbers"};
  physics.place_robot(*pose);
  return std::nullopt;
}

Result<std::unique_ptr<World>> open(const WorldOptions& options) {
  if (!std::isfinite(options.footprint_m) || options.footprint_m < 0)
    return Problem{"the footprint must be a number from 0 up"};
  auto physics = Physics::load(options.world);
  if (!physics) return Problem{physics.problem()};
  if (auto problem = put_robot_at_start(**physics, options)) return std::move(*problem);
  std::optional<Track> floor;
  if (!options.track.empty()) {
    auto track = Track::load(options.track, options.metres_per_pixel);
    if (!track) return Problem{track.problem()};
    floor = std::move(*track);
  }
  auto simulation = std::make_shared<Simulation>(std::move(*physics), std::move(floor), options.trace);
  return std::unique_ptr<World>(
      std::make_unique<MujocoWorld>(std::move(simulation), options.footprint_m, options.seed));
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
  return tessera::sim::value_or_null(
      tessera::sim::without_exceptions([&] { return tessera::sim::open(options); }), error);
}
