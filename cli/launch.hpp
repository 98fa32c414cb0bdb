#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/process.hpp"
#include "cli/project.hpp"

/// Running a built controller: what `simulate` and `run` have in common.
namespace tessera::cli {

/// Options of the command line that reach the controller.
struct LaunchOptions {
  std::string spec = ".";
  std::string duration;  ///< "60s"; empty: until stopped
  std::vector<std::string> set, inject;
  std::string parameters;  ///< file; empty: params.yaml of the project if there is one
  std::string record, record_values = "small", record_limit;
  bool debug = false;
  Gate gate;
  // Of the simulated world.
  std::string track, start;
  double metres_per_pixel = 0, footprint_mm = 0;  ///< 0: as in the specification
  std::uint64_t seed = 1;
};

/// Declares the options shared by `simulate` and `run`.
void declare(CLI::App& command, LaunchOptions& options);
/// Declares the options of the simulated world.
void declare_world(CLI::App& command, LaunchOptions& options);

/// The files a run leaves in .tessera/last/.
struct RunFiles {
  std::filesystem::path recording, trace, summary;
};
[[nodiscard]] RunFiles run_files(const Specification& specification, const LaunchOptions& options);

/// The floor picture a run uses: of the command line, else of the specification.
struct Floor {
  std::filesystem::path image;
  double metres_per_pixel = 0.005;
};
/// nullopt: no track. Throws std::runtime_error when it names a file that is nowhere.
[[nodiscard]] std::optional<Floor> floor_of(const Specification& specification, const LaunchOptions& options);

/// The controller's command line. mode: "simulate" or "run"; with_world: in the simulated world.
[[nodiscard]] Command controller_command(const Controller& controller, const LaunchOptions& options,
                                         const std::string& mode, bool with_world);

}  // namespace tessera::cli
