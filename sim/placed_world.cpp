#include "sim/placed_world.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/compose/compose.hpp"
#include "sim/compose/layout.hpp"
#include "sim/engine/seeds.hpp"
#include "sim/variation.hpp"

namespace tessera::sim {
namespace {

using nlohmann::json;

/// Models that are drawn from the volume of one site, at one distance from each other.
struct ScatterGroup {
  std::string site;
  double apart_m = 0;
  std::vector<std::size_t> members;  ///< of all placements
};

Placement placement_of(const json& written) {
  Placement placement;
  placement.name = written.at("instance").get<std::string>();
  placement.model = written.at("model").get<std::string>();
  if (const auto at = written.find("at_m"); at != written.end()) {
    placement.x_m = at->at(0).get<double>();
    placement.y_m = at->at(1).get<double>();
    placement.z_m = at->at(2).get<double>();
  }
  placement.heading_rad = written.value("heading_rad", 0.0);
  if (const auto pose = written.find("pose"); pose != written.end())
    placement.keyframe = pose->get<std::string>();
  return placement;
}

std::vector<ScatterGroup> groups_of(const json& models) {
  std::vector<ScatterGroup> groups;
  for (std::size_t index = 0; index < models.size(); ++index) {
    const auto site = models[index].value("scatter", std::string());
    if (site.empty()) continue;
    const double apart_m = models[index].value("apart_m", 0.0);
    auto group = std::ranges::find_if(
        groups, [&](const ScatterGroup& one) { return one.site == site && one.apart_m == apart_m; });
    if (group == groups.end()) group = groups.insert(group, {site, apart_m, {}});
    group->members.push_back(index);
  }
  return groups;
}

/// Problem: there is no such site, or the models do not fit.
std::optional<Problem> scatter_groups(const WorldOptions& options, const json& models,
                                      std::vector<Placement>& placements) {
  for (const ScatterGroup& group : groups_of(models)) {
    std::vector<Placement> members;
    for (const std::size_t index : group.members) members.push_back(placements[index]);
    Result<std::vector<Placement>> drawn =
        scatter(options.world, group.site, group.apart_m, seed_of("scatter " + group.site, options.seed),
                std::move(members));
    if (!drawn) return Problem{drawn.problem()};
    for (std::size_t n = 0; n < group.members.size(); ++n) placements[group.members[n]] = (*drawn)[n];
  }
  return std::nullopt;
}

std::vector<Variation> variations_of(const json& models) {
  std::vector<Variation> variations;
  for (const json& model : models) {
    const auto vary = model.find("vary");
    if (vary == model.end()) continue;
    for (const auto& [what, ends] : vary->items())
      variations.push_back({model.at("instance").get<std::string>(), what, ends.at(0).get<double>(),
                            ends.at(1).get<double>()});
  }
  return variations;
}

/// The composition of the placed models.
Result<Composition> composition_of(const WorldOptions& options, const json& models) {
  std::vector<Placement> placements;
  for (const json& one : models) placements.push_back(placement_of(one));
  if (auto problem = scatter_groups(options, models, placements)) return std::move(*problem);
  return compose(options.world, placements);
}

Result<std::unique_ptr<Physics>> physics_of(const WorldOptions& options, const Composition& composition,
                                            const json& variations) {
  Result<ComposedWorld> world = load(composition);
  if (!world) return Problem{world.problem()};
  for (const std::string& warning : world->warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (auto problem = vary(*world->model, variations_of(variations), options.seed)) return std::move(*problem);
  auto physics = Physics::of(std::move(world->model), options.world);
  if (physics)
    (*physics)->start_with(
        [&](const mjModel& model, mjData& data) { set_state(model, world->initial, data); });
  return physics;
}

}  // namespace

Result<std::unique_ptr<Physics>> physics_of(const WorldOptions& options) {
  if (options.models.empty()) return Physics::load(options.world);
  const json models = json::parse(options.models);
  const Result<Composition> composition = composition_of(options, models);
  if (!composition) return Problem{composition.problem()};
  return physics_of(options, *composition, models);
}

}  // namespace tessera::sim
