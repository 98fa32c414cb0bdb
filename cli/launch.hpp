#pragma once

#include "cli/arguments.hpp"
#include "project/launch.hpp"

/// Options that several commands share.
namespace tessera::cli {

/// Declares --verify-timeout and --accept-violations.
void declare_gate(Subcommand& command, project::Gate& gate);
/// Declares the options shared by `simulate` and `run`.
void declare(Subcommand& command, project::LaunchOptions& options);
/// Declares the options of the simulated world.
void declare_world(Subcommand& command, project::LaunchOptions& options);

}  // namespace tessera::cli
