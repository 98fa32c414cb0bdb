#include <fmt/core.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "bag/live_bag.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/deploy.hpp"
#include "cli/early_checks.hpp"
#include "cli/launch.hpp"
#include "cli/outcome.hpp"
#include "cli/outputs.hpp"
#include "cli/recordings/bags.hpp"
#include "cli/recordings/coverage.hpp"
#include "cli/recordings/process_bags.hpp"
#include "cli/terminal.hpp"
#include "cli/timing/reenactment.hpp"
#include "diagnostics/source.hpp"
#include "mcap/records.hpp"
#include "project/files/run_folder.hpp"
#include "project/process/death.hpp"
#include "tessera/printable.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct SimulateOptions : SimulatedRunOptions {
  std::string report, ros2_clock, from;
  bool realtime = false, interleave = false;
};

struct RunCommandOptions : LaunchOptions {
  std::string json, report, process, mcap;
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
           const std::string& coverage = {}, const std::string& mcap = {}, const std::string& scenario = {}) {
  if (options.debug) return print_debugger_line(command);
  const RunFiles files = run_files(options);
  const std::filesystem::path note = death_note(files);
  std::optional<bag::LiveBag> live;
  if (!mcap.empty())
    live.emplace(files.recording.string(), mcap, background_of(controller.specification), bag_library);
  const Exit exit = run(with_death_note(command, note));
  if (const std::string problem = live ? live->finish() : ""; !problem.empty()) complain(problem);
  if (!std::filesystem::exists(files.summary)) {
    if (const std::string death = describe_death(exit, note); !death.empty())
      complain(death);
    else
      folder.withdraw();
    return exit.code == 0 ? failed : exit.code;
  }
  RunOutcome outcome = read_outcome(controller, options);
  // Files first: the terminal may be closed, and then nothing can be printed.
  if (!json.empty() && json != "-") write_output(json, to_json(outcome));
  if (!report_folder.empty()) {
    outcome.chains = chain_times_of(outcome, controller.specification.model);
    write_report(outcome, controller.report, report_folder);
  }
  std::optional<Reenactment> again;
  if (const std::optional<PromisedTimes> promised = promised_times(scenario); promised && exit.code == 0) {
    std::string problem;
    if (const auto recording = read_recording(outcome.recording.string(), problem))
      again = compare(*promised, *recording, controller.specification.model);
    else
      again = Reenactment{problem, false};
  }
  std::optional<CoverageInput> reached;
  if (!coverage.empty()) reached.emplace(controller.specification).add_file(outcome.recording.string());
  if (reached && coverage != "-") report_coverage(*reached, coverage, /*shown=*/false);
  const bool is_printed = is_printed_to_the_end([&] {
    if (json != "-" && coverage != "-") print(outcome);
    if (again && again->is_same && json != "-" && coverage != "-") fmt::print("{}\n", printable(again->text));
    if (json == "-") write_output(json, to_json(outcome));
    if (coverage == "-") report_coverage(*reached, coverage, /*shown=*/false);
    if (reached && json != "-" && coverage != "-") report_coverage(*reached, shown_only, /*shown=*/true);
  });
  if (again && !again->is_same) return complain(again->text);
  return exit.code == 0 && !is_printed ? failed : exit.code;
}

/// Called before any long work.
void check_outputs(const LaunchOptions& options, const std::string& json, const std::string& report) {
  check_recording(options.record);
  check_replaceable(json, "{");
  check_report(report);
}

/// A simulated run whose real inputs get their values from a recording or a bag.
int simulate_from(SimulateOptions options) {
  if (const int code = check_run(options, /*with_world=*/false); code != ok) return code;
  check_outputs(options, options.json, options.report);
  std::optional<Controller> controller =
      make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  const RunFolder folder = folder_for(*controller, options, "simulate", /*is_recorded=*/true);
  const RunInputs inputs = inputs_of_run(controller->specification, options.from, options.folder);
  if (options.duration.empty()) options.duration = inputs.duration;
  Command command = controller_command(*controller, options, "simulate", /*simulated=*/false);
  command.insert(command.end(), {"--inputs", inputs.file});
  if (options.interleave) command.emplace_back("--interleave");
  if (options.realtime) command.emplace_back("--realtime");
  return launch(*controller, folder, options, command, options.json, options.report, options.coverage);
}

int simulate_command(SimulateOptions options) {
  if (diagnostics::is_xml_file(options.spec))
    return complain(fmt::format("{0} is a net without a controller: `tessera play {0}`", options.spec)),
           usage;
  if (!options.from.empty()) return simulate_from(std::move(options));
  check_report(options.report);
  auto prepared = prepare_simulated_run(options, "simulate", /*is_recorded=*/true, "60s");
  if (const int* const code = std::get_if<int>(&prepared)) return *code;
  auto& [controller, folder, command] = std::get<SimulatedRun>(prepared);
  if (options.interleave) command.emplace_back("--interleave");
  if (options.realtime) command.emplace_back("--realtime");
  if (!options.ros2_clock.empty()) command.insert(command.end(), {"--ros2-clock", options.ros2_clock});
  return launch(controller, folder, options, command, options.json, options.report, options.coverage, {},
                options.scenario);
}

/// One process of a deployed system, run like any other.
int launch_process(const Controller& controller, const RunFolder& folder, const RunCommandOptions& options) {
  Command command = controller_command(controller, options, "run", /*simulated=*/false);
  add_process(command, options.process, options.deploy.network);
  return launch(controller, folder, options, command, options.json, options.report, {}, options.mcap);
}

/// A managed node has any number of runs, also none, and tells of each itself.
int launch_managed(const Controller& controller, const RunFolder& folder, const RunCommandOptions& options) {
  const Command command = controller_command(controller, options, "run", options.world);
  if (options.debug) return print_debugger_line(command);
  const RunFiles files = run_files(options);
  const std::filesystem::path note = death_note(files);
  const Exit exit = run(with_death_note(command, note));
  if (!std::filesystem::exists(files.summary)) folder.withdraw();
  return exit.code;
}

int run_command(RunCommandOptions options) {
  if ((options.deploy.asked || !options.process.empty()) && options.world)
    return complain("a simulated world is in one process: `tessera simulate` runs all processes in it"),
           usage;
  if (options.deploy.asked && options.ros2_arguments)
    return complain("--ros-args is for one process: start it with --process NAME"), usage;
  if (!options.hardware.empty() && !options.world)
    return complain("--hardware is for simulated runs: this one has real drivers everywhere");
  if (const int code = check_run(options, options.world); code != ok) return code;
  if (options.deploy.asked)
    ProcessBags::check(options.mcap);
  else
    check_replaceable(options.mcap, mcap::magic);
  if (!check_deployment(options.spec, options.deploy, options.process)) return failed;
  if (!every_real_buffer_has_driver(options, options.world, terminal())) return failed;
  check_outputs(options, options.json, options.report);
  std::optional<Controller> controller =
      make_controller(options.spec, {options.debug, "controller", options.gate}, terminal());
  if (!controller) return exit_code_without_net();
  if (options.world && !controller->specification.model.simulation)
    return complain("the specification has no `simulation`, so there is nothing to simulate");
  const RunFolder folder = folder_for(*controller, options, "run", /*is_recorded=*/true);
  options.deploy.bags = options.mcap;
  if (options.deploy.asked) return run_deployed(*controller, folder, options, options.deploy);
  if (options.managed) return launch_managed(*controller, folder, options);
  if (!options.process.empty()) return launch_process(*controller, folder, options);
  return launch(*controller, folder, options, controller_command(*controller, options, "run", options.world),
                options.json, options.report, {}, options.mcap);
}

}  // namespace

int run_project(const std::filesystem::path& project, std::vector<std::string> set,
                const std::string& duration) {
  RunCommandOptions options;
  options.spec = project.string();
  options.set = std::move(set);
  options.duration = duration;
  return run_command(std::move(options));
}

void add_simulate(CommandLine& app) {
  Subcommand command = app.add("simulate", "Build the controller and run it in its simulated world");
  SimulateOptions& options = command.runs(simulate_command);
  declare_simulated_run_options(command, options);
  declare_single_run_options(command, options);
  command.flag("--interleave", options.interleave,
               "Subsystems take turns after every firing, drawn from the seed, as in `tessera schedules`");
  command.flag("--realtime", options.realtime, "Not faster than the wall clock");
  command.option(
      "--ros2-clock", options.ros2_clock,
      "Publish the simulated time as /clock of ROS 2 on this network interface, for example lo; it is "
      "then not faster than the wall clock (docs/use/ros2.md)");
  Option from =
      command
          .option(
              "--from", options.from,
              "Without world and devices: real inputs get their values from this bag (MCAP) or recording, at "
              "its times; topics go to the buffers that `drivers` names for them (docs/use/replay.md)")
          .existing_file();
  for (const char* other :
       {"--hardware", "--scenario", "--track", "--start", "--metres-per-pixel", "--network", "--ros2-clock"})
    from.excludes(command.declared(other));
  command.option("--report", options.report, "Folder for a page and a picture of the run");
  command.declared("--hardware").excludes(command.declared("--scenario"));
  command.footer(
      "Examples:\n"
      "  tessera simulate --for 60s --seed 1 --report report\n"
      "  tessera simulate robot --track mine.png --metres-per-pixel 0.002 --start 0.4,0.2,90 --set v=0.15\n"
      "  tessera simulate --from monday.mcap              your code on the sensors of a bag\n"
      "Many runs: `tessera schedules`. On recorded inputs: `tessera rerun`. A net in PNML: `tessera play`.");
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

void add_run(CommandLine& app) {
  Subcommand command =
      app.add("run", "Build the controller and run it on the steady clock with real drivers");
  RunCommandOptions& options = command.runs(run_command);
  declare_run_options(command, options);
  declare_single_run_options(command, options);
  declare_world_options(command, options);
  command.flag("--world", options.world,
               "With the simulated drivers, in the simulated world if there is one, in real time");
  command.option("--json", options.json, "Write the outcome as JSON (- is standard output)");
  command.option("--report", options.report, "Folder for a page and a picture of the run");
  command.option("--mcap", options.mcap,
                 "Also write a bag for the tools of ROS 2 while it runs: a chunk a second, readable whatever "
                 "happens; with --deploy: a folder of bags, one for each process (docs/use/replay.md)");
  command.flag("--no-monitor", options.no_monitor,
               "Without a control socket: `tessera emergency-stop`, `set` and `top` cannot reach this run");
  declare_deployment_options(command, options);
  command.words(
      "--ros-args", options.ros2_arguments,
      "Names and parameters as ROS 2 gives them, up to -- or the end: -r FROM:=TO, -r __node:=NAME, "
      "-r __ns:=/SPACE, -p NAME:=VALUE, --params-file FILE (docs/use/ros2.md)");
  Option managed = command.flag("--managed", options.managed,
                                "As a managed node of ROS 2: devices move only while it is active "
                                "(docs/use/ros2.md)");
  for (const char* other : {"--deploy", "--process", "--mcap", "--json", "--report"})
    managed.excludes(command.declared(other));
  command.footer(
      "Examples:\n  tessera run\n  tessera run --world --for 10s\n"
      "  tessera run --deploy --restart on-failure       every process of this machine (docs/use/fleets.md)");
}

}  // namespace tessera::cli
