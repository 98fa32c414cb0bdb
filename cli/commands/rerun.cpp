#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/early_checks.hpp"
#include "cli/launch.hpp"
#include "cli/outputs.hpp"
#include "cli/recordings/bags.hpp"
#include "cli/terminal.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct RerunOptions : LaunchOptions {
  std::string recording, json;
};

/// Without a world and without a new recording.
int rerun_command(RerunOptions options) {
  if (const int code = check_run(options, /*with_world=*/false); code != ok) return code;
  check_replaceable(options.json, "{");
  std::optional<Controller> controller =
      make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  const RunFolder folder = folder_for(*controller, options, "again", /*is_recorded=*/false);
  const RunFiles files = run_files(options);
  const std::string recording = unpacked(options.recording, options.folder).value_or(options.recording);
  Command command{controller->program.string(),
                  "simulate",
                  "--from",
                  std::filesystem::absolute(recording).string(),
                  "--summary",
                  files.summary.string()};
  for (const std::string& value : options.set) command.insert(command.end(), {"--set", value});
  if (options.debug) return print_debugger_line(command);
  const Exit exit = run(command);
  if (!options.json.empty() && std::filesystem::exists(files.summary))
    write_output(options.json, nlohmann::json::parse(std::ifstream(files.summary)).dump(2) + "\n");
  return exit.code;
}

}  // namespace

void add_rerun(CommandLine& app) {
  Subcommand command =
      app.add("rerun", "Run user code again on the inputs of a recording, and compare the results");
  RerunOptions& options = command.runs(rerun_command);
  command.option("recording", options.recording, "Recording of a run").required().existing_file();
  declare_specification(command, options.spec);
  command.option("--set", options.set, "PATH=VALUE: change a parameter (v=0.3, robot.control.v=0.3)")
      .repeated();
  declare_verification_gate(command, options.gate);
  command.flag("--debug", options.debug, "Build for gdb and print the command that debugs this");
  command.option("--json", options.json, "Write the outcome as JSON (- is standard output)");
  command.footer("Example: tessera rerun field.tsr   would this code have done the same there?");
}

}  // namespace tessera::cli
