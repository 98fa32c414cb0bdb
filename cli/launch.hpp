#pragma once

#include <string>
#include <variant>

#include "cli/arguments.hpp"
#include "project/build/controller.hpp"
#include "project/files/run_folder.hpp"
#include "project/launch.hpp"
#include "project/process/process.hpp"

/// Options that several commands share.
namespace tessera::cli {

/// Declares the argument that names the specification.
void declare_specification(Subcommand& command, std::string& spec);
/// Declares --verify-timeout and --accept-violations.
void declare_verification_gate(Subcommand& command, project::VerificationGate& gate);
/// Declares the options of all runs: `simulate`, `schedules` and `run`.
void declare_run_options(Subcommand& command, project::LaunchOptions& options);
/// Declares the options of a run by itself, which may be recorded, use real devices and be debugged.
void declare_single_run_options(Subcommand& command, project::LaunchOptions& options);
/// Declares the options of the simulated world.
void declare_world_options(Subcommand& command, project::LaunchOptions& options);

/// The options of simulated runs: `simulate` and `schedules`.
struct SimulatedRunOptions : project::LaunchOptions {
  std::string scenario, coverage, json;
};
/// Declares them, with those of all runs and of the world.
void declare_simulated_run_options(Subcommand& command, SimulatedRunOptions& options);

/// The controller of simulated runs, and the command line of one. `--scenario` shows a violation, so such a
/// controller is made although the property is violated.
struct SimulatedRun {
  project::Controller controller;
  project::RunFolder folder;
  project::Command command;
};
/// Checks the options and makes the controller. mode: of the folder. usual_duration: without `--for`. Returns the
/// exit code if there is no run.
[[nodiscard]] std::variant<SimulatedRun, int> prepare_simulated_run(SimulatedRunOptions& options,
                                                                    const char* mode, bool is_recorded,
                                                                    const char* usual_duration);

/// Makes the folder of a run, and puts its controller there.
[[nodiscard]] project::RunFolder folder_for(project::Controller& controller, project::LaunchOptions& options,
                                            const char* mode, bool is_recorded);

/// Prints the command that debugs the run of this one in gdb. Returns the exit code.
int print_debugger_line(const project::Command& command);

}  // namespace tessera::cli
