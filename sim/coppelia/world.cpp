#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "sim/coppelia/contents.hpp"
#include "sim/coppelia/devices.hpp"
#include "sim/coppelia/lock_step.hpp"
#include "sim/coppelia/view.hpp"
#include "sim/devices/making.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::coppelia {
namespace {

constexpr const char* no_checks = "worlds of CoppeliaSim have no checks and measures";

/// A scene of CoppeliaSim. Without a scene, its devices are only judged.
class CoppeliaWorld final : public sim::WorldOfDevices<DeviceContext> {
 public:
  using WorldOfDevices::WorldOfDevices;

  [[nodiscard]] std::shared_ptr<WorldState> state(const std::string& agent) override {
    return context_.scene == nullptr ? nullptr : view_of(context_.scene, agent);
  }
  void advance_to(Time time) override {
    if (context_.scene != nullptr) context_.scene->advance_to(time);
  }
  [[nodiscard]] std::optional<Problem> problem_with_checks(const std::string& /*json*/) override {
    return Problem{no_checks};
  }
  [[nodiscard]] bool finish(std::string& error) override {
    const auto problem = context_.scene == nullptr ? std::nullopt : context_.scene->finish();
    if (problem) error = problem->text;
    return !problem;
  }
};

Result<std::unique_ptr<World>> open(const WorldOptions& options) {
  if (!options.server) return Problem{"this library simulates nothing by itself: it needs a server"};
  if (!options.track.empty() || options.start_x_m)
    return Problem{"a floor picture and a start pose are for worlds of MuJoCo; CoppeliaSim's scene has both"};
  if (!options.checks.empty()) return Problem{no_checks};
  DeviceContext context{nullptr, options.seed};
  if (!options.only_asked) context.scene = std::make_shared<LockStep>(*options.server);
  return std::unique_ptr<World>(std::make_unique<CoppeliaWorld>(std::move(context)));
}

Result<std::string> list(const WorldOptions& options) {
  if (!options.server) return Problem{"this library simulates nothing by itself: it needs a server"};
  return contents_as_json(*options.server);
}

}  // namespace
}  // namespace tessera::coppelia

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

/// Opens a scene of CoppeliaSim; throws nothing. See tessera::OpenWorld.
extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::World> tessera_open_world_4(
    const tessera::WorldOptions& options, std::string& error) {
  return tessera::sim::value_or_null(
      tessera::sim::without_exceptions([&] { return tessera::coppelia::open(options); }), error);
}

/// Lists the contents of a CoppeliaSim scene; throws nothing. See tessera::ListWorld.
extern "C" __attribute__((visibility("default"))) bool tessera_list_world_4(
    const tessera::WorldOptions& options, std::string& json, std::string& error) {
  return tessera::sim::text_or_false(
      tessera::sim::without_exceptions([&] { return tessera::coppelia::list(options); }), json, error);
}
