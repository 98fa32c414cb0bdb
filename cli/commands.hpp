#pragma once

#include <CLI/CLI.hpp>

/// The subcommands. Each declares its options on `app` and sets the function that runs it; that function
/// stores the command's exit code in `exit_code`.
namespace tessera::cli {

void add_new(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_show(CLI::App& app, int& exit_code);
void add_verify(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_generate(CLI::App& app, int& exit_code);
void add_test(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_studio(CLI::App& app, int& exit_code);
void add_top(CLI::App& app, int& exit_code);
void add_set(CLI::App& app, int& exit_code);
void add_emergency_stop(CLI::App& app, int& exit_code);
void add_reset(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);

}  // namespace tessera::cli
