#pragma once

#include <CLI/CLI.hpp>

#include "project/launch.hpp"

/// Options that several commands have in common.
namespace tessera::cli {

/// Declares --verify-timeout and --accept-violations.
void declare_gate(CLI::App& app, project::Gate& gate);
/// Declares the options shared by `simulate` and `run`.
void declare(CLI::App& command, project::LaunchOptions& options);
/// Declares the options of the simulated world.
void declare_world(CLI::App& command, project::LaunchOptions& options);

}  // namespace tessera::cli
