#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "tessera/device.hpp"

/// What a controller and the world's library need of the section `simulation`.
namespace tessera::project {

/// A driver of the world as the world sees it, with the type of its buffer but without its encoding.
[[nodiscard]] DriverRequest request_of(const spec::Model& model, const spec::Driver& driver);

/// The placed models as JSON: a list of objects (docs/worlds.md); empty: there are none. Their files are
/// absolute. project: the folder of the specification.
[[nodiscard]] std::string placements_json(const spec::Simulation& simulation,
                                          const std::filesystem::path& project);

/// The content of the simulation file of a run, JSON with `drivers` and `models`.
[[nodiscard]] std::string simulation_json(const spec::Model& model, const std::filesystem::path& project);

}  // namespace tessera::project
