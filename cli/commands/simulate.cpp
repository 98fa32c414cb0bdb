#include <fmt/core.h>

#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/commands/deploy.hpp"
#include "cli/commands/panel.hpp"
#include "cli/coverage.hpp"
#include "cli/early_checks.hpp"
#include "cli/launch.hpp"
#include "cli/outcome.hpp"
#include "cli/outputs.hpp"
#include "cli/play_net.hpp"
#include "cli/schedules.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "project/files/run_folder.hpp"
#include "project/files/state_folder.hpp"
#include "project/process/death.hpp"

namespace tessera::cli {

using namespace project;

namespace {

constexpr int most_jobs = 4096;

struct SimulateOptions : LaunchOptions {
  std::string json, report, scenario, from, coverage, ros2_clock;
  bool realtime = false, interleave = false;
  ScheduleOptions schedules;
  std::uint64_t steps = PlayOptions{}.steps;
};

struct RunCommandOptions : LaunchOptions {
  std::string json, report, process;
  bool world = false;
  DeployOptions deploy;
};

/// Whether `print` succeeds. The run is over, so its exit code must not get lost.
template <class Print>
bool is_printed_to_the_end(Print print) {
  try {
    print();
    return true;
  } catch (const std::exception& problem) {
    complain(problem.what());
    return false;
  }
}

// Even a run that failed writes a summary, which says why. Only a controller that could not start leaves
// none.
int launch(const Controller& controller, const RunFolder& folder, const LaunchOptions& options,
           const Command& command, const std::string& json, const std::string& report_folder,
           const std::string& coverage = {}) {
  if (options.debug) return print_debugger_line(command);
  const RunFiles files = run_files(options);
  const std::filesystem::path note = death_note(files);
  const Exit exit = run(with_death_note(command, note));
  if (!std::filesystem::exists(files.summary)) {
    if (const std::string death = describe_death(exit, note); !death.empty())
      complain(death);
    else
      folder.withdraw();
    return exit.code == 0 ? failed : exit.code;
  }
  const RunOutcome outcome = read_outcome(controller, options);
  // Files first: the terminal may be closed, and then nothing can be printed.
  if (!json.empty() && json != "-") write_output(json, to_json(outcome));
  if (!report_folder.empty()) write_report(outcome, controller.report, report_folder);
  std::optional<CoverageInput> reached;
  if (!coverage.empty()) reached.emplace(controller.specification).add_file(outcome.recording.string());
  if (reached && coverage != "-") report_coverage(*reached, coverage, /*shown=*/false);
  const bool is_printed = is_printed_to_the_end([&] {
    if (json != "-" && coverage != "-") print(outcome);
    if (json == "-") write_output(json, to_json(outcome));
    if (coverage == "-") report_coverage(*reached, coverage, /*shown=*/false);
    if (reached && json != "-" && coverage != "-") report_coverage(*reached, shown_only, /*shown=*/true);
  });
  return exit.code == 0 && !is_printed ? failed : exit.code;
}

// The command that repeats one of the schedules, alone and recorded, when its seed is appended.
std::string reproduction(const SimulateOptions& options) {
  Command line{"tessera", "simulate", options.spec, "--interleave", "--for", options.duration};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) line.insert(line.end(), {option, value});
  };
  for (const std::string& value : options.set) add("--set", value);
  for (const std::string& fault : options.inject) add("--inject", fault);
  if (options.accept_stuck) line.emplace_back("--accept-stuck");
  if (options.gate.accept_violations) line.emplace_back("--accept-violations");
  add("--parameters", options.parameters);
  add("--network", options.network);
  add("--track", options.track);
  if (options.metres_per_pixel > 0) add("--metres-per-pixel", fmt::format("{}", options.metres_per_pixel));
  if (!options.start.empty()) line.push_back("--start=" + options.start);
  add("--scenario", options.scenario);
  line.emplace_back("--seed");
  return shell_line(line);
}

// Runs user code again on recorded data: without a world, without a new recording.
int run_again(const Controller& controller, const SimulateOptions& options) {
  const RunFiles files = run_files(options);
  Command command{controller.program.string(),
                  "simulate",
                  "--from",
                  std::filesystem::absolute(options.from).string(),
                  "--summary",
                  files.summary.string()};
  for (const std::string& value : options.set) command.insert(command.end(), {"--set", value});
  if (options.debug) return print_debugger_line(command);
  const Exit exit = run(command);
  if (!options.json.empty() && std::filesystem::exists(files.summary))
    write_output(options.json, nlohmann::json::parse(std::ifstream(files.summary)).dump(2) + "\n");
  return exit.code;
}

/// Makes the folder of the run, and puts its controller there.
RunFolder folder_for(Controller& controller, LaunchOptions& options, const char* mode, bool is_recorded) {
  const auto shown = is_recorded && !options.debug ? RunFolder::Shown::as_last : RunFolder::Shown::no;
  RunFolder folder(state_folder(controller.specification.project), mode, shown, terminal());
  options.folder = folder.path().string();
  controller.program = folder.own_copy_of(controller.program);
  folder.goes_to_children();
  return folder;
}

/// Called before any long work.
void check_outputs(const LaunchOptions& options, const std::string& json, const std::string& report) {
  check_recording(options.record);
  check_replaceable(json, "{");
  check_report(report);
}

/// The options of schedules have no effect without them.
bool schedules_fit(const SimulateOptions& options) {
  const ScheduleOptions& schedules = options.schedules;
  const bool is_asked = !schedules.part.empty() || schedules.jobs > 0 || !schedules.results.empty();
  if (schedules.count == 0 && is_asked)
    return complain("--part, --jobs and --results are for --schedules N"), false;
  return is_part(schedules.part);
}

int simulate_command(SimulateOptions options) {
  if (!schedules_fit(options)) return usage;
  if (diagnostics::is_xml_file(options.spec))
    return play_net({options.spec, options.steps, options.seed, options.json});
  if (const int code = check_run(options, options.from.empty()); code != ok) return code;
  // A scenario shows a violation, so the controller must be made although the property is violated.
  if (!options.scenario.empty()) options.gate.accept_violations = true;
  check_outputs(options, options.json, options.report);
  check_replaceable(options.schedules.results, "{");
  if (options.coverage != shown_only) check_replaceable(options.coverage, "{");
  if (options.from.empty() && !every_real_buffer_has_driver(options, /*simulated=*/true, terminal()))
    return failed;
  std::optional<Controller> controller =
      make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  const bool is_recorded = options.from.empty() && options.schedules.count == 0;
  const char* mode = is_recorded ? "simulate" : options.from.empty() ? "schedules" : "again";
  const RunFolder folder = folder_for(*controller, options, mode, is_recorded);
  if (!options.from.empty()) return run_again(*controller, options);
  tell_of_panels(controller->specification.model);
  if (options.duration.empty()) options.duration = options.schedules.count > 0 ? "1s" : "60s";
  Command command = controller_command(*controller, options, "simulate", /*simulated=*/true);
  if (options.interleave) command.push_back("--interleave");
  if (options.realtime) command.push_back("--realtime");
  if (!options.ros2_clock.empty()) {
    command.emplace_back("--ros2-clock");
    command.push_back(options.ros2_clock);
  }
  if (!options.scenario.empty()) {
    command.emplace_back("--scenario");
    command.push_back(std::filesystem::absolute(options.scenario).string());
  }
  if (options.schedules.count > 0) {
    options.schedules.json = options.json;
    options.schedules.coverage = options.coverage;
    options.schedules.again = reproduction(options);
    return run_schedules(*controller, options, options.schedules, std::move(command));
  }
  return launch(*controller, folder, options, command, options.json, options.report, options.coverage);
}

/// One process of a deployed system, run like any other.
int launch_process(const Controller& controller, const RunFolder& folder, const RunCommandOptions& options) {
  Command command = controller_command(controller, options, "run", /*simulated=*/false);
  add_process(command, options.process, options.deploy.network);
  return launch(controller, folder, options, command, options.json, options.report);
}

int run_command(RunCommandOptions options) {
  if ((options.deploy.asked || !options.process.empty()) && options.world)
    return complain("a simulated world is in one process: `tessera simulate` runs all processes in it"),
           usage;
  if (!options.hardware.empty() && !options.world)
    return complain("--hardware is for simulated runs: this one has real drivers everywhere");
  if (const int code = check_run(options, options.world); code != ok) return code;
  if (!check_deployment(options.spec, options.deploy, options.process)) return failed;
  if (!every_real_buffer_has_driver(options, options.world, terminal())) return failed;
  check_outputs(options, options.json, options.report);
  std::optional<Controller> controller =
      make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  if (options.world && !controller->specification.model.simulation)
    return complain("the specification has no `simulation`, so there is nothing to simulate");
  const RunFolder folder = folder_for(*controller, options, "run", /*is_recorded=*/true);
  if (options.deploy.asked) return run_deployed(*controller, folder, options, options.deploy);
  if (!options.process.empty()) return launch_process(*controller, folder, options);
  return launch(*controller, folder, options, controller_command(*controller, options, "run", options.world),
                options.json, options.report);
}

}  // namespace

void add_simulate(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("simulate", "Build the controller and run it in its simulated world");
  auto options = std::make_shared<SimulateOptions>();
  declare_run_options(command, *options);
  declare_world_options(command, *options);
  command
      .option("--scenario", options->scenario,
              "Drive the controller through this run first (tessera verify --scenario)")
      .existing_file();
  Option from = command
                    .option("--from", options->from,
                            "Run user code again on the inputs of this recording, and compare the results")
                    .existing_file();
  Option schedules = command
                         .option("--schedules", options->schedules.count,
                                 "Run this many interleavings, with seeds from --seed on, of 1 s or --for "
                                 "each; report the failures "
                                 "and their probability")
                         .within(1, std::numeric_limits<int>::max());
  command.option("--part", options->schedules.part, "Schedules: only one part of the seeds, 3/20");
  command.option("--jobs", options->schedules.jobs, "Schedules: processes at a time (default: one per core)")
      .within(1, most_jobs);
  command.option("--results", options->schedules.results,
                 "Schedules: write the counts to this file, which `tessera merge` joins with others");
  command.flag("--coverage", options->coverage, shown_only,
               "Show the parts of the net that were not reached; --coverage=FILE writes JSON, too");
  command.flag(
      "--interleave", options->interleave,
      "Subsystems take turns after every firing, drawn from the seed, as in the runs of --schedules");
  command.flag("--realtime", options->realtime, "Not faster than the wall clock");
  command
      .option(
          "--ros2-clock", options->ros2_clock,
          "Publish the simulated time as /clock of ROS 2 on this network interface, for example lo; it is "
          "then not faster than the wall clock (docs/use/ros2.md)")
      .excludes(schedules);
  command.option("--steps", options->steps, "PNML files, which have no controller: how often to fire")
      .shows_default();
  command.option("--json", options->json, "Write the outcome as JSON (- is standard output)");
  command.option("--report", options->report, "Folder for a page and a picture of the run")
      .excludes(schedules);
  command.declared("--record").excludes(schedules);
  command.option("--network", options->network,
                 "Network between the processes of `deploy`, for example delay=2ms,jitter=1ms,loss=0.1,"
                 "duplicate=0.01,reorder=0.05 (docs/use/fleets.md)");
  for (const char* other : {"--for", "--seed", "--inject", "--record", "--record-values", "--record-limit",
                            "--track", "--start", "--scenario", "--schedules", "--coverage", "--interleave",
                            "--realtime", "--report", "--hardware", "--ros2-clock"})
    from.excludes(command.declared(other));
  for (const char* other : {"--schedules", "--scenario"})
    command.declared("--hardware").excludes(command.declared(other));
  command.footer(
      "Examples:\n"
      "  tessera simulate --for 60s --seed 1 --report report\n"
      "  tessera simulate robot --track mine.png --metres-per-pixel 0.002 --start 0.4,0.2,90 --set v=0.15\n"
      "  tessera simulate --schedules 1000 --for 1s      is there an interleaving that goes wrong?\n"
      "  tessera simulate --schedules 1000000 --part 3/20 --results part3.json   see `tessera merge`\n"
      "  tessera simulate --schedules 100 --coverage     which parts has no run reached?\n"
      "  tessera simulate --from field.tsr               would this code have done the same there?\n"
      "  tessera simulate net.pnml --steps 1000000 --seed 7   a net of any origin; ties are drawn by lot");
  command.callback([options, &exit_code] { exit_code = simulate_command(*options); });
}

namespace {

void declare_deployment_options(Subcommand& command, RunCommandOptions& options) {
  Option deploy = command.flag("--deploy", options.deploy.asked,
                               "Systems with `deploy`: start all processes whose host is this machine");
  Option process = command.option("--process", options.process, "Systems with `deploy`: run this process");
  deploy.excludes(process);
  command
      .option("--only", options.deploy.only,
              "Start these processes, whatever their host: office,cart[0],cart[*]")
      .needs(deploy);
  command
      .option("--restart", options.deploy.restart,
              "Start a process again that has failed: never, or on-failure (five times in a row, ever later)")
      .one_of({"never", "on-failure"})
      .shows_default()
      .needs(deploy);
  command
      .option("--on-failure", options.deploy.on_failure,
              "If a process has failed and is not started again: stop the others, or let them go-on")
      .one_of({"stop", "go-on"})
      .shows_default()
      .needs(deploy);
  project::NetworkOptions& network = options.deploy.network;
  command.option("--domain", network.domain, "DDS domain (default: that of `deploy`)");
  command.option("--interface", network.interface, "Network interface (default: that of `deploy`)");
  command.option("--peers", network.peers, "Hosts of the other processes: A,B (default: those of `deploy`)");
  for (const char* other : {"--record", "--json", "--report", "--debug"})
    deploy.excludes(command.declared(other));
}

}  // namespace

void add_run(CommandLine& app, int& exit_code) {
  Subcommand command =
      app.add("run", "Build the controller and run it on the steady clock with real drivers");
  auto options = std::make_shared<RunCommandOptions>();
  declare_run_options(command, *options);
  declare_world_options(command, *options);
  command.flag("--world", options->world,
               "With the simulated drivers, in the simulated world if there is one, in real time");
  command.option("--json", options->json, "Write the outcome as JSON (- is standard output)");
  command.option("--report", options->report, "Folder for a page and a picture of the run");
  command.flag("--no-monitor", options->no_monitor,
               "Without a control socket: `tessera emergency-stop`, `set` and `top` cannot reach this run");
  declare_deployment_options(command, *options);
  command.footer(
      "Examples:\n  tessera run\n  tessera run --world --for 10s\n"
      "  tessera run --deploy --restart on-failure       every process of this machine (docs/use/fleets.md)");
  command.callback([options, &exit_code] { exit_code = run_command(*options); });
}

}  // namespace tessera::cli
