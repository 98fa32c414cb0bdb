#pragma once

#include "cli/arguments.hpp"

/// The subcommands. Each declares its options on `app` and sets the function that runs it; that function
/// stores the command's exit code in `exit_code`.
namespace tessera::cli {

void add_new(CommandLine& app, int& exit_code);
void add_check(CommandLine& app, int& exit_code);
void add_migrate(CommandLine& app, int& exit_code);
void add_rename(CommandLine& app, int& exit_code);
void add_show(CommandLine& app, int& exit_code);
void add_verify(CommandLine& app, int& exit_code);
void add_export(CommandLine& app, int& exit_code);
void add_generate(CommandLine& app, int& exit_code);
void add_package(CommandLine& app, int& exit_code);
void add_test(CommandLine& app, int& exit_code);
void add_simulate(CommandLine& app, int& exit_code);
void add_run(CommandLine& app, int& exit_code);
void add_schedules(CommandLine& app, int& exit_code);
void add_merge(CommandLine& app, int& exit_code);
void add_rerun(CommandLine& app, int& exit_code);
void add_play(CommandLine& app, int& exit_code);
void add_replay(CommandLine& app, int& exit_code);
void add_studio(CommandLine& app, int& exit_code);
void add_top(CommandLine& app, int& exit_code);
void add_set(CommandLine& app, int& exit_code);
void add_panel(CommandLine& app, int& exit_code);
void add_emergency_stop(CommandLine& app, int& exit_code);
void add_reset(CommandLine& app, int& exit_code);
void add_world(CommandLine& app, int& exit_code);
void add_lsp(CommandLine& app, int& exit_code);
void add_completion(CommandLine& app, int& exit_code);

}  // namespace tessera::cli
