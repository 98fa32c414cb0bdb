#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "project/build/controller.hpp"
#include "project/parameter_file.hpp"
#include "project/process/process.hpp"

/// Starts a controller that has been built.
namespace tessera::project {

/// How a controller is to be run.
struct LaunchOptions {
  std::string spec = ".";
  std::string duration;  ///< "60s"; empty: no limit
  std::vector<std::string> set, inject;
  std::string parameters;  ///< file; empty: params.yaml of the project if there is one
  std::string record, record_values = "small", record_limit;
  std::string folder;  ///< of the run's files (RunFolder)
  /// relative names are relative to this folder
  std::filesystem::path base = std::filesystem::current_path();
  std::string network;        ///< conditions between simulated processes; empty: the usual ones
  bool accept_stuck = false;  ///< a subsystem that is stuck for good at the end is not a failure
  /// paths of the subsystems and buffers with real drivers in a simulated run
  std::vector<std::string> hardware;
  std::optional<std::vector<std::string>> ros2_arguments;  ///< in real time: the words behind `--ros-args`
  bool also = false;        ///< start although another run uses the same real devices
  bool managed = false;     ///< in real time: as a managed node of ROS 2
  bool no_monitor = false;  ///< in real time: without a control socket
  bool debug = false;
  bool progress = false;  ///< the controller shows its progress on standard error
  VerificationGate gate;
  // The options of the simulated world.
  std::string world, track, start;  ///< empty: as in the specification
  double metres_per_pixel = 0;      ///< 0: as in the specification
  std::uint64_t seed = 1;
};

/// The files that a run leaves.
struct RunFiles {
  std::filesystem::path recording, summary;
};
[[nodiscard]] RunFiles run_files(const LaunchOptions& options);

/// The floor picture of a run: the one on the command line, or else the one in the specification.
struct Floor {
  std::filesystem::path image;
  double metres_per_pixel = 0.005;
};
/// nullopt: there is no track. Throws std::runtime_error if the file does not exist.
[[nodiscard]] std::optional<Floor> floor_of(const Specification& specification, const LaunchOptions& options);

/// Every parameter that a run changes: first those of the file, then those of the command line. Throws
/// std::runtime_error, with file and line, if the file cannot be read or a value has a wrong unit.
[[nodiscard]] std::vector<GivenParameter> given_parameters(const Specification& specification,
                                                           const LaunchOptions& options);

/// The same as PATH=VALUE.
[[nodiscard]] std::vector<std::string> parameter_values(const Specification& specification,
                                                        const LaunchOptions& options);

/// The limit of every recording, unless `record_limit` gives another one; "none" is no limit.
inline constexpr const char* usual_record_limit = "1GB";

/// Whether every real buffer has a driver for such a run; reports those that have none, and what to do.
/// simulated: of the simulated robot, but for the hardware that the options name. Also true if the
/// specification cannot be read, because another function reports that.
[[nodiscard]] bool every_real_buffer_has_driver(const LaunchOptions& options, bool simulated,
                                                Listener& listener);

/// The controller's command line. mode: "simulate" or "run"; simulated: use the simulated robot,
/// in its world if it has one. Then it writes simulation.json into the folder of the run.
[[nodiscard]] Command controller_command(const Controller& controller, const LaunchOptions& options,
                                         const std::string& mode, bool simulated);

/// The file in which the controller of a run leaves a note if it dies during the run.
[[nodiscard]] std::filesystem::path death_note(const RunFiles& files);

/// The command of a controller that this process starts and waits for: it stops when this process ends, and
/// leaves a note if it dies.
[[nodiscard]] Command with_death_note(Command command, const std::filesystem::path& note);

}  // namespace tessera::project
