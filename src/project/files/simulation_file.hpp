#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "tessera/device.hpp"

/// The parts of the section `simulation` that a controller and the world's library need.
namespace tessera::project {

/// A driver of the world as the world sees it, with the type of its buffer but without its encoding.
[[nodiscard]] DriverRequest request_of(const spec::Model& model, const spec::Driver& driver);

/// The placed models as JSON: a list of objects (docs/use/worlds.md); empty: there are none. Their files are
/// absolute. project: the folder of the specification.
[[nodiscard]] std::string placements_json(const spec::Simulation& simulation,
                                          const std::filesystem::path& project);

/// One check or measure, as World::problem_with_checks reads it.
[[nodiscard]] std::string check_json(const checks::Check& check);
[[nodiscard]] std::string measure_json(const checks::Measure& measure);

/// The content of the simulation file of a run, JSON with `drivers`, `models`, `checks` and `measures`.
/// With `picture`, what else a run was of, for who draws the world later; absolute paths.
struct WorldPicture {
  std::filesystem::path world, track;  ///< track: empty: none
  double metres_per_pixel = 0.005;
  std::uint64_t seed = 1;
};
[[nodiscard]] std::string simulation_json(const spec::Model& model, const std::filesystem::path& project,
                                          const std::optional<WorldPicture>& picture);
/// The world of a run, from its simulation file. nullopt: the file is not there, or is of another version.
[[nodiscard]] std::optional<WorldOptions> world_of_run(const std::filesystem::path& simulation_file);

}  // namespace tessera::project
