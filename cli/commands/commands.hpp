#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/arguments.hpp"

/// The subcommands. Each declares its options on `app` and sets the function that runs it.
namespace tessera::cli {

/// Builds the controller of a project and runs it with real drivers, as `run` does. set: PATH=VALUE of parameters.
/// duration: "60s"; empty: no limit. Returns the exit code.
[[nodiscard]] int run_project(const std::filesystem::path& project, std::vector<std::string> set,
                              const std::string& duration);

void add_new(CommandLine& app);
void add_check(CommandLine& app);
void add_migrate(CommandLine& app);
void add_rename(CommandLine& app);
void add_show(CommandLine& app);
void add_verify(CommandLine& app);
void add_export(CommandLine& app);
void add_generate(CommandLine& app);
void add_package(CommandLine& app);
void add_test(CommandLine& app);
void add_simulate(CommandLine& app);
void add_run(CommandLine& app);
void add_schedules(CommandLine& app);
void add_merge(CommandLine& app);
void add_rerun(CommandLine& app);
void add_play(CommandLine& app);
void add_replay(CommandLine& app);
void add_studio(CommandLine& app);
void add_top(CommandLine& app);
void add_set(CommandLine& app);
void add_panel(CommandLine& app);
void add_emergency_stop(CommandLine& app);
void add_reset(CommandLine& app);
void add_world(CommandLine& app);
void add_lsp(CommandLine& app);
void add_guard(CommandLine& app);
void add_completion(CommandLine& app);

}  // namespace tessera::cli
