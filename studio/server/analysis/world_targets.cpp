#include "server/analysis/world_targets.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "project/files/chosen_world.hpp"
#include "project/files/world_check.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

struct KindOfDriver {
  const char *kind, *list;
};
/// docs/use/worlds.md
constexpr std::array kinds{KindOfDriver{"sensor", "sensors"},        KindOfDriver{"joint_position", "joints"},
                           KindOfDriver{"joint_velocity", "joints"}, KindOfDriver{"scan", "sites"},
                           KindOfDriver{"pose", "bodies"},           KindOfDriver{"pose", "sites"},
                           KindOfDriver{"contact", "bodies"},        KindOfDriver{"contact", "sites"},
                           KindOfDriver{"camera", "cameras"},        KindOfDriver{"depth", "cameras"},
                           KindOfDriver{"labels", "cameras"},        KindOfDriver{"reflectance", "sites"},
                           KindOfDriver{"actuator", "actuators"},    KindOfDriver{"velocity", "actuators"},
                           KindOfDriver{"weld", "equalities"},       KindOfDriver{"mocap", "bodies"},
                           KindOfDriver{"place", "bodies"},          KindOfDriver{"colour", "geoms"}};

/// "laser" for "robot[3]/laser", if robot[3] is an agent.
std::string as_in_drivers(const std::string& name, const spec::Model& model) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) return name;
  const bool of_agent = std::ranges::any_of(
      model.agents, [&](const auto& agent) { return agent.path == name.substr(0, slash); });
  return of_agent ? name.substr(slash + 1) : name;
}

/// Whether drivers of that kind can move a body.
bool is_moved_by(const json& entry, const std::string& kind) {
  return (kind != "mocap" && kind != "place") || entry.value("moved_by", "") == kind;
}

}  // namespace

Result<json> world_targets(const spec::Model& model, const std::filesystem::path& project) {
  json all = json::object();
  if (!model.simulation || model.simulation->coppelia || model.simulation->world.empty()) return all;
  const auto world = project::world_of(*model.simulation, project);
  if (!world) return Problem{"there is no world " + model.simulation->world};
  const Result<std::string> told = project::contents_of_world(*world);
  if (!told) return Problem{told.problem()};
  const json contents = json::parse(*told);
  for (const auto& [kind, list] : kinds) {
    json& names = all[kind];
    if (names.is_null()) names = json::array();
    if (!contents.contains(list)) continue;
    for (const json& entry : contents.at(list)) {
      const std::string name = as_in_drivers(entry.value("name", ""), model);
      if (is_moved_by(entry, kind) && !name.empty() && !std::ranges::count(names, json(name)))
        names.push_back(name);
    }
  }
  return all;
}

}  // namespace tessera::server
