#include "project/files/world_check.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <set>

#include "project/files/installation.hpp"
#include "project/files/simulation_file.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// A function of the library of worlds, which stays loaded.
Result<void*> function_of_library(const fs::path& file, const char* name) {
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Problem{"cannot load the library of worlds: " + std::string(dlerror())};
  void* const function = dlsym(library, name);
  if (function == nullptr) return Problem{file.string() + " is of another version: it has no " + name};
  return function;
}

/// The position of a problem in the specification.
diagnostics::Span place_of(const spec::Driver& driver, const DriverProblem& problem) {
  if (const auto option = driver.option_spans.find(problem.subject); option != driver.option_spans.end())
    return option->second;
  const auto target = std::ranges::find(driver.targets, problem.subject, &spec::Driver::Target::name);
  if (target != driver.targets.end()) return target->span;
  return driver.targets.empty() ? driver.span : driver.targets.front().span;
}

diagnostics::Span place_of(const spec::Simulation& simulation) {
  if (simulation.coppelia) return simulation.coppelia->span;
  return simulation.world.empty() ? simulation.span : simulation.world_span;
}

/// One message for a whole fleet.
class Judge {
 public:
  Judge(const spec::Model& model, World& world, diagnostics::Diagnostics& out)
      : model_(model), world_(world), out_(out) {}

  void judge(const spec::Driver& driver) {
    const bool effector = model_.subsystem(driver.instance).kind == spec::SubsystemKind::effector;
    const auto problem = world_.problem_with(request_of(model_, driver), effector);
    if (!problem) return;
    ok_ = false;
    const diagnostics::Span place = place_of(driver, *problem);
    if (said_.insert({place, problem->subject}).second)
      out_.error(problem->second_writer ? "E319" : "E311", place, problem->text, problem->hint);
  }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  const spec::Model& model_;
  World& world_;
  diagnostics::Diagnostics& out_;
  std::set<std::pair<diagnostics::Span, std::string>> said_;
  bool ok_ = true;
};

}  // namespace

Result<std::unique_ptr<World>> open_world_to_ask(ChosenWorld chosen) {
  const auto function = function_of_library(chosen.library, open_world_function);
  if (!function) return Problem{function.problem()};
  chosen.options.only_asked = true;
  std::string error;
  auto world = reinterpret_cast<OpenWorld>(*function)(chosen.options, error);
  if (world == nullptr) return Problem{error};
  return world;
}

Result<std::string> contents_of_world(const ChosenWorld& world) {
  const auto function = function_of_library(world.library, list_world_function);
  if (!function) return Problem{function.problem()};
  std::string json, error;
  if (!reinterpret_cast<ListWorld>(*function)(world.options, json, error)) return Problem{error};
  return json;
}

Result<std::unique_ptr<WorldPainter>> open_painter(const WorldOptions& options,
                                                   const PictureOptions& picture) {
  const auto function = function_of_library(Installation::find().world_library, open_painter_function);
  if (!function) return Problem{function.problem()};
  std::string error;
  auto painter = reinterpret_cast<OpenPainter>(*function)(options, picture, error);
  if (painter == nullptr) return Problem{error};
  return painter;
}

bool check_world(const spec::Model& model, const fs::path& project, const std::string& world,
                 diagnostics::Diagnostics& out) {
  if (!model.simulation) return true;
  const spec::Simulation& simulation = *model.simulation;
  const auto chosen = world_of(simulation, project, world);
  if (!chosen) return true;  // there is none, or its file is missing, which another function reports
  const diagnostics::Span place = place_of(simulation);
  if (!fs::exists(chosen->library)) {
    out.note("N313", place,
             "the library of simulated worlds is not installed, so the devices are not checked");
    return true;
  }
  ChosenWorld asked = *chosen;
  if (simulation.track) {
    if (const auto picture = find_asset(simulation.track->image, project, "tracks"))
      asked.options.track = picture->string();
    asked.options.metres_per_pixel = simulation.track->metres_per_pixel;
  }
  const auto opened = open_world_to_ask(std::move(asked));
  if (!opened) {
    out.error("E312", place, "the world cannot be opened: " + opened.problem());
    return false;
  }
  Judge judge(model, **opened, out);
  for (const spec::Driver& driver : simulation.drivers)
    if (driver.is_of_world()) judge.judge(driver);
  bool ok = judge.ok();
  const auto judge_text = [&](const std::string& json, diagnostics::Span its_place) {
    const auto problem = (*opened)->problem_with_checks(json);
    if (!problem) return;
    out.error("E314", its_place, problem->text);
    ok = false;
  };
  for (const spec::WorldCheck& one : simulation.checks) judge_text(check_json(one.check), one.span);
  for (const spec::WorldMeasure& one : simulation.measures) judge_text(measure_json(one.measure), one.span);
  return ok;
}

}  // namespace tessera::project
