#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "sim/contents.hpp"
#include "sim/devices/kinds.hpp"
#include "sim/devices/making.hpp"
#include "sim/painter.hpp"
#include "sim/placed_world.hpp"
#include "sim/simulation.hpp"
#include "sim/view_of_world.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {
namespace {

class MujocoWorld final : public WorldOfDevices<DeviceContext> {
 public:
  using WorldOfDevices::WorldOfDevices;

  [[nodiscard]] std::shared_ptr<WorldState> state(const std::string& agent) override {
    return view_of_world(context_.simulation, agent);
  }

  void advance_to(Time time) override { context_.simulation->advance_to(time); }
  [[nodiscard]] std::optional<Problem> problem_with_checks(const std::string& json) override {
    return context_.simulation->problem_with_checks(json);
  }
  [[nodiscard]] std::vector<WorldFailure> take_failures() override {
    return context_.simulation->take_failures();
  }
  [[nodiscard]] std::string results() override { return context_.simulation->results(); }
  [[nodiscard]] std::optional<WorldScene> scene(std::span<const DriverRequest> devices) override {
    return context_.simulation->scene(devices);
  }
  void show_poses(PoseSink& sink) override { context_.simulation->show_poses(sink); }
  [[nodiscard]] bool finish(std::string& error) override {
    const std::optional<Problem> problem = context_.simulation->finish();
    if (problem) error = problem->text;
    return !problem;
  }
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
  auto physics = physics_of(options);
  if (!physics) return Problem{physics.problem()};
  if (auto problem = put_robot_at_start(**physics, options)) return std::move(*problem);
  std::optional<Track> floor;
  if (!options.track.empty()) {
    auto track = Track::load(options.track, options.metres_per_pixel);
    if (!track) return Problem{track.problem()};
    floor = std::move(*track);
  }
  auto simulation = std::make_shared<Simulation>(std::move(*physics), std::move(floor), options.trace);
  if (auto problem = simulation->judge_by(options.checks)) return std::move(*problem);
  auto renderer = std::make_shared<Renderer>(TrackFile{options.track, options.metres_per_pixel});
  return std::unique_ptr<World>(std::make_unique<MujocoWorld>(
      DeviceContext{std::move(simulation), options.footprint_m, options.seed, std::move(renderer)}));
}

Result<std::string> list(const WorldOptions& options) {
  const auto physics = physics_of(options);
  if (!physics) return Problem{physics.problem()};
  return contents_as_json((*physics)->model());
}

}  // namespace
}  // namespace tessera::sim

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

/// Opens a MuJoCo world; throws nothing. See tessera::OpenWorld.
extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::World> tessera_open_world_4(
    const tessera::WorldOptions& options, std::string& error) {
  return tessera::sim::value_or_null(
      tessera::sim::without_exceptions([&] { return tessera::sim::open(options); }), error);
}

/// Lists the contents of a MuJoCo world; throws nothing. See tessera::ListWorld.
extern "C" __attribute__((visibility("default"))) bool tessera_list_world_4(
    const tessera::WorldOptions& options, std::string& json, std::string& error) {
  return tessera::sim::text_or_false(
      tessera::sim::without_exceptions([&] { return tessera::sim::list(options); }), json, error);
}

/// Opens a MuJoCo world for drawing; throws nothing. See tessera::OpenPainter.
extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::WorldPainter>
tessera_open_painter_1(const tessera::WorldOptions& options, const tessera::PictureOptions& picture,
                       std::string& error) {
  return tessera::sim::value_or_null(
      tessera::sim::without_exceptions([&] { return tessera::sim::open_painter(options, picture); }), error);
}
