#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "project/files/chosen_world.hpp"
#include "spec/model/model.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

/// Asks the library of simulated worlds, without running anything.
namespace tessera::project {

/// A world that is open to be asked. No server is called. Problem: the library is not installed, or the world does not open.
[[nodiscard]] Result<std::unique_ptr<World>> open_world_to_ask(ChosenWorld world);
/// The contents of a world, as JSON.
[[nodiscard]] Result<std::string> contents_of_world(const ChosenWorld& world);
/// A world of MuJoCo to be drawn as it was recorded. Problem: as OpenPainter, or the library is not installed.
[[nodiscard]] Result<std::unique_ptr<WorldPainter>> open_painter(const WorldOptions& options,
                                                                 const PictureOptions& picture);

/// Whether the devices of the simulation are in the world, and fit their buffers. The files of the simulation
/// exist (check_simulation_files). No server is called, so objects in a scene of CoppeliaSim are not looked
/// up.
///
/// world: the file that is used in place of that of the specification; empty: none.
/// Errors: E311 a device that the world does not have, or that does not fit; E312 the world cannot be opened.
///         Note N313: the library of worlds is not installed, so the devices are not checked.
bool check_world(const spec::Model& model, const std::filesystem::path& project, const std::string& world,
                 diagnostics::Diagnostics& out);

}  // namespace tessera::project
