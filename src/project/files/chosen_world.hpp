#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "spec/model/model.hpp"
#include "tessera/device.hpp"

namespace tessera::project {

/// A simulated world, and the library that simulates it.
struct ChosenWorld {
  WorldOptions options;  ///< the specification's settings of the world itself; no track, seed or checks
  std::filesystem::path library;
  std::string name;  ///< for people: "/home/me/hall.xml", "CoppeliaSim at localhost:23000"
};

/// A file that is a world of MuJoCo.
[[nodiscard]] ChosenWorld world_in(const std::filesystem::path& file);

/// The world of a simulation. instead: the MuJoCo file that is used in its place; empty: none.
/// nullopt: there is none, or its file does not exist.
[[nodiscard]] std::optional<ChosenWorld> world_of(const spec::Simulation& simulation,
                                                  const std::filesystem::path& project,
                                                  const std::string& instead = {});

/// Whether the server runs on this machine, so that it sees our files.
[[nodiscard]] bool is_here(const spec::CoppeliaServer& server);

/// The settings of a server for the controller. A scene that is a file of the project has its whole path.
[[nodiscard]] WorldServer server_of(const spec::CoppeliaServer& server, const std::filesystem::path& project);

}  // namespace tessera::project
