#include "project/files/chosen_world.hpp"

#include <fmt/core.h>

#include "project/files/installation.hpp"
#include "project/files/simulation_file.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

ChosenWorld world_in(const fs::path& file) {
  ChosenWorld world{{}, Installation::find().world_library, file.string()};
  world.options.world = file.string();
  return world;
}

std::optional<ChosenWorld> world_of(const spec::Simulation& simulation, const fs::path& project,
                                    const std::string& instead) {
  if (simulation.coppelia && instead.empty()) {
    ChosenWorld world{{}, Installation::find().coppelia_library, {}};
    world.options.server = server_of(*simulation.coppelia, project);
    world.name = fmt::format("CoppeliaSim at {}:{}", simulation.coppelia->host, simulation.coppelia->port);
    return world;
  }
  const std::string& wanted = instead.empty() ? simulation.world : instead;
  const auto file = wanted.empty() ? std::nullopt : find_asset(wanted, project, "worlds");
  if (!file) return std::nullopt;
  ChosenWorld world = world_in(*file);
  world.options.models = placements_json(simulation, project);
  return world;
}

bool is_here(const spec::CoppeliaServer& server) {
  return server.host == "localhost" || server.host == "::1" || server.host.starts_with("127.");
}

WorldServer server_of(const spec::CoppeliaServer& server, const fs::path& project) {
  WorldServer told{server.host, server.port, server.scene, server.timeout};
  if (server.scene.empty() || !is_here(server)) return told;
  if (const auto file = find_asset(server.scene, project, "worlds")) told.scene = file->string();
  return told;
}

}  // namespace tessera::project
