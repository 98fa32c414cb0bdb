#include "project/files/assets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "project/files/chosen_world.hpp"
#include "project/files/installation.hpp"
#include "tessera/nearest.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// The files in `folder` whose names end like `name`.
void add_alike(const fs::path& folder, const fs::path& name, std::set<std::string>& found) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_regular_file(ignored) && entry.path().extension() == name.extension())
      found.insert(entry.path().filename().string());
}

std::string what_is_there(const fs::path& name, const fs::path& project, const fs::path& shipped) {
  std::set<std::string> found;
  add_alike(project, name, found);
  add_alike(shipped, name, found);
  const std::vector<std::string> names(found.begin(), found.end());
  if (std::string near = did_you_mean(name.string(), names).text; !near.empty()) return near;
  constexpr std::size_t shown = 6;
  std::string list;
  for (std::size_t at = 0; at < std::min(shown, names.size()); ++at)
    list += (list.empty() ? "there are " : ", ") + names[at];
  return list;
}

bool check_file(const std::string& name, std::string_view what, const std::string& folder,
                const diagnostics::Span& at, const fs::path& project, diagnostics::Diagnostics& out) {
  if (name.empty() || find_asset(name, project, folder)) return true;
  const fs::path shipped = Installation::find().share / folder;
  const std::string where =
      fs::path(name).is_absolute() ? "" : fmt::format(" in {} or {}", project.string(), shipped.string());
  out.error("E310", at, fmt::format("there is no {} {}{}", what, diagnostics::in_quotes(name), where),
            what_is_there(name, project, shipped));
  return false;
}

}  // namespace

bool check_simulation_files(const spec::Model& model, const fs::path& project,
                            diagnostics::Diagnostics& out) {
  if (!model.simulation) return true;
  const spec::Simulation& simulation = *model.simulation;
  bool found = simulation.world.empty() ||
               check_file(simulation.world, "world", "worlds", simulation.world_span, project, out);
  if (simulation.coppelia && is_here(*simulation.coppelia))
    found = check_file(simulation.coppelia->scene, "scene", "worlds", simulation.coppelia->scene_span,
                       project, out);
  for (const spec::ModelPlacement& placement : simulation.models)
    if (&placement == &simulation.models.front() || (&placement)[-1].span != placement.span)
      found = check_file(placement.model, "model", "worlds", placement.model_span, project, out) && found;
  if (simulation.track)
    found = check_file(simulation.track->image, "picture", "tracks", simulation.track->image_span, project,
                       out) &&
            found;
  return found;
}

}  // namespace tessera::project
