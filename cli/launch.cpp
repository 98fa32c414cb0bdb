#include "cli/launch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/early_checks.hpp"
#include "cli/outcome.hpp"
#include "cli/outputs.hpp"
#include "cli/recordings/coverage.hpp"
#include "cli/terminal.hpp"
#include "project/files/installation.hpp"
#include "project/files/state_folder.hpp"
#include "spec/model/model.hpp"

namespace tessera::cli {

namespace {

/// Prints the panels that cannot be operated in a simulated run without a control socket.
void tell_of_panels(const spec::Model& model) {
  if (!model.simulation) return;
  std::vector<std::string> paths;
  for (const spec::Driver& driver : model.simulation->drivers)
    if (driver.panel && driver.panel->script.empty()) paths.push_back(model.driver_path(driver));
  if (paths.empty()) return;
  constexpr std::size_t most = 3;
  const std::size_t more = paths.size() > most ? paths.size() - most : 0;
  paths.resize(paths.size() - more);
  fmt::print(stderr,
             "note: nobody operates the panel{} {}{} in this run, so no value comes from there; the studio's "
             "simulate and `tessera run --world` can be operated\n",
             paths.size() > 1 ? "s" : "", fmt::join(paths, ", "),
             more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace

void declare_specification(Subcommand& command, std::string& spec) {
  command.option("spec", spec, "Specification, or the folder of its spec.yaml").shows_default();
}

void declare_verification_gate(Subcommand& command, project::VerificationGate& gate) {
  command.option("--verify-timeout", gate.timeout, "How long verification may take, such as 10s or 2min")
      .shows_default();
  command.flag("--accept-violations", gate.accept_violations,
               "Make the controller although a property is violated (it carries the verdicts)");
}

void declare_run_options(Subcommand& command, project::LaunchOptions& options) {
  options.progress = isatty(STDERR_FILENO) != 0;
  declare_specification(command, options.spec);
  command.option("--for", options.duration, "How long to run: 60s, 500ms, 2min");
  command.option("--set", options.set, "PATH=VALUE: change a parameter (v=0.3, robot.control.v=0.3)")
      .repeated();
  command.option("--parameters", options.parameters,
                 "YAML file of parameters (default: params.yaml of the project)");
  command
      .option("--inject", options.inject,
              "Plant a fault, FAULT@WHEN: robot.control.follow:throw@2.5s, robot.control:stall=200ms@1s, "
              "device:robot.motor@any (docs/use/running.md)")
      .repeated();
  command.flag("--accept-stuck", options.accept_stuck,
               "Do not fail if a subsystem waits for ever while others go on");
  declare_verification_gate(command, options.gate);
}

void declare_single_run_options(Subcommand& command, project::LaunchOptions& options) {
  command.option("--record", options.record,
                 "The file of the recording (default: in the folder of the run, which .tessera/last shows)");
  command.option(
      "--record-limit", options.record_limit,
      fmt::format("Keep the newest part of the recording only: 500MB in all, or 100MBx5, five files of "
                  "100 MB; none: all of it (default: {})",
                  project::usual_record_limit));
  command
      .option("--record-values", options.record_values,
              "Which values of buffers to record: none, small (up to 4 KiB; of larger ones a hash), all")
      .one_of({"none", "small", "all"})
      .shows_default();
  command
      .option("--hardware", options.hardware,
              "SUBSYSTEM or BUFFER that keeps its real driver (hardware in the loop); the simulated clock is "
              "then not faster than the wall clock")
      .repeated();
  command.flag("--also", options.also, "Start although another run uses the same real devices");
  command.flag("--debug", options.debug, "Build for gdb and print the command that debugs this run");
}

void declare_world_options(Subcommand& command, project::LaunchOptions& options) {
  command.option("--seed", options.seed, "Seed of sensor noise and of ties between subsystems")
      .shows_default();
  command.option("--track", options.track, "PNG of the floor, dark is line");
  command.option("--metres-per-pixel", options.metres_per_pixel, "Scale of the floor picture").positive();
  command.option("--start", options.start,
                 "Start pose X,Y,DEGREES: metres from the lower left corner (default: on the line)");
}

void declare_simulated_run_options(Subcommand& command, SimulatedRunOptions& options) {
  declare_run_options(command, options);
  declare_world_options(command, options);
  command
      .option("--scenario", options.scenario,
              "Drive the controller through this run first (tessera verify --scenario)")
      .existing_file();
  command.flag("--coverage", options.coverage, shown_only,
               "Show the parts of the net that were not reached; --coverage=FILE writes JSON, too");
  command.option("--network", options.network,
                 "Network between the processes of `deploy`, for example delay=2ms,jitter=1ms,loss=0.1,"
                 "duplicate=0.01,reorder=0.05 (docs/use/fleets.md)");
  command.option("--json", options.json, "Write the outcome as JSON (- is standard output)");
}

std::variant<SimulatedRun, int> prepare_simulated_run(SimulatedRunOptions& options, const char* mode,
                                                      bool is_recorded, const char* usual_duration) {
  if (const int code = check_run(options, /*with_world=*/true); code != ok) return code;
  if (!options.scenario.empty()) options.gate.accept_violations = true;
  check_recording(options.record);
  check_replaceable(options.json, "{");
  if (options.coverage != shown_only) check_replaceable(options.coverage, "{");
  if (!project::every_real_buffer_has_driver(options, /*simulated=*/true, terminal())) return failed;
  std::optional<project::Controller> controller =
      project::make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  project::RunFolder folder = folder_for(*controller, options, mode, is_recorded);
  tell_of_panels(controller->specification.model);
  if (options.duration.empty()) options.duration = usual_duration;
  project::Command command = controller_command(*controller, options, "simulate", /*simulated=*/true);
  if (!options.scenario.empty()) {
    command.emplace_back("--scenario");
    command.push_back(std::filesystem::absolute(options.scenario).string());
  }
  return SimulatedRun{*std::move(controller), std::move(folder), std::move(command)};
}

project::RunFolder folder_for(project::Controller& controller, project::LaunchOptions& options,
                              const char* mode, bool is_recorded) {
  using project::RunFolder;
  const auto shown = is_recorded && !options.debug ? RunFolder::Shown::as_last : RunFolder::Shown::no;
  RunFolder folder(project::state_folder(controller.specification.project), mode, shown, terminal());
  options.folder = folder.path().string();
  controller.program = folder.own_copy_of(controller.program);
  folder.goes_to_children();
  return folder;
}

int print_debugger_line(const project::Command& command) {
  const auto printers = project::Installation::find().share / "gdb/tessera_printers.py";
  project::Command line{"gdb", "-ix", printers.string(), "--args"};
  line.insert(line.end(), command.begin(), command.end());
  fmt::print("{}\n", project::shell_line(line));
  return ok;
}

}  // namespace tessera::cli
