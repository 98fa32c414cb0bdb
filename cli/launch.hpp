#pragma once

#include <string>

#include "cli/arguments.hpp"
#include "project/launch.hpp"
#include "project/process/process.hpp"

/// Options that several commands share.
namespace tessera::cli {

/// Declares the argument that names the specification.
void declare_specification(Subcommand& command, std::string& spec);
/// Declares --verify-timeout and --accept-violations.
void declare_verification_gate(Subcommand& command, project::VerificationGate& gate);
/// Declares the options shared by `simulate` and `run`.
void declare_run_options(Subcommand& command, project::LaunchOptions& options);
/// Declares the options of the simulated world.
void declare_world_options(Subcommand& command, project::LaunchOptions& options);

/// Prints the command that debugs the run of this one in gdb. Returns the exit code.
int print_debugger_line(const project::Command& command);

}  // namespace tessera::cli
