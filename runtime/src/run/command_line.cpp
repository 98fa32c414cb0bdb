#include "run/command_line.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string_view>
#include <vector>

#include "network/carrier.hpp"
#include "parameters/parameters.hpp"
#include "run/driver_requests.hpp"
#include "safety/device_claims.hpp"
#include "tessera/channel_limits.hpp"

namespace tessera {
namespace {

constexpr unsigned most_jobs = 4096;
constexpr const char* ros2_flag = "--ros-args";

/// The options as the user wrote them, before they are interpreted.
struct Words {
  std::string duration, parameter_file, record_limit, simulation, skip_to;
  std::vector<std::string> parameters, drivers;
  std::vector<double> start;
  int domain = -1;
  std::uint64_t incarnation = 0;
  WorldOptions world;
  bool unwatched = false, controlled = false;
};

void describe_common(CLI::App& command, CommandLine& line, Words& words) {
  RunOptions& options = line.options;
  command.add_option("--for", words.duration,
                     "End after this time: 60s, 2min, 500ms (default: run until the net ends)");
  command
      .add_option("--set", words.parameters,
                  "PATH=VALUE: v=0.3 (everywhere), robot.control.v=0.3, robot[*].control.v=0.3")
      ->allow_extra_args(false);
  command.add_option("--parameters", words.parameter_file,
                     "File of 'path = value' lines, applied before --set");
  // The runs of a managed node get another file and another parent than the node.
  command
      .add_option("--record", options.recording,
                  "Write every firing, log line and value of a buffer to this file")
      ->take_first();
  command.add_option(
      "--record-limit", words.record_limit,
      "Keep the newest part of the recording only: 500MB in all, or 100MBx5, five files of 100 MB");
  using Values = RunOptions::Values;
  command
      .add_option("--record-values", options.values,
                  "Which values of buffers: none, small (up to 4 KiB; of larger ones a hash), all")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Values>{
          {"none", Values::none}, {"small", Values::small}, {"all", Values::all}}))
      ->default_str("small");
  command.add_option("--world", words.world.world, "World of the simulated robot (MJCF)");
  command.add_option("--world-library", options.world_library, "Library that simulates the world");
  command.add_option("--track", words.world.track, "Floor picture (PNG), dark is line");
  command.add_option("--metres-per-pixel", words.world.metres_per_pixel, "Scale of the floor picture")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--start", words.start, "x,y,deg: where the robot starts (metres, degrees)")
      ->delimiter(',')
      ->expected(3);
  command
      .add_option("--footprint", words.world.footprint_m, "Diameter of what a light sensor sees, in metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--trace", words.world.trace, "Write the path driven to this file");
  command
      .add_option("--driver", words.drivers,
                  "BUFFER=KIND:TARGET[,OPTION=NUMBER...]: robot.sensor.left=reflectance:eye_left,noise=0.01")
      ->allow_extra_args(false);
  command.add_option("--simulation", words.simulation,
                     "Devices of the world and models placed in it (JSON, docs/use/worlds.md)");
  command
      .add_option(
          "--inject", options.inject,
          "FAULT@WHEN: robot.control.follow:throw@2.5s, robot.control:stall=200ms@1s, "
          "robot.sensor:nan@3s, device:robot.motor@1s..2s, silent:robot.sensor@1s.., "
          "signal:SIGINT@2s, link:base-cart[0]:cut=2s@3s, process:cart[0]:restart=2s@3s; WHEN may be `any`")
      ->allow_extra_args(false);
  command
      .add_option(
          "--hardware", options.hardware,
          "SUBSYSTEM or BUFFER that has its real driver in a simulated run (hardware in the loop); the "
          "simulated clock is then not faster than the wall clock")
      ->allow_extra_args(false);
  command.add_option("--seed", options.seed, "The seed of ties and sensor noise")->capture_default_str();
  command.add_option("--summary", line.summary, "Write the result of the run as JSON; - is standard output");
  command.add_flag("--accept-stuck", options.accept_stuck,
                   "Do not fail if a subsystem waits for ever while others go on");
  command.add_flag("--progress", options.progress, "Show progress on standard error");
  command.add_option("--death-note", options.death_note,
                     "If the process dies during the run, write to this file where and why");
  command.add_option(
      "--project", options.project,
      "Folder of the project, whose real devices have one run at a time (default: by the place "
      "of this program)");
  command.add_flag("--also", options.also, "Start although another run uses the same real devices");
  command
      .add_option(
          "--parent", options.parent,
          "Number of the process that started the controller; when it has ended, the run stops safely")
      ->take_first()
      ->check(CLI::PositiveNumber);
}

void describe_network(CLI::App& run, CLI::App& simulate, RunOptions::Network& network, Words& words) {
  static_assert(last_domain == network::last_domain);
  run.add_option("--process", network.process, "The process of the deployment to run (docs/use/fleets.md)");
  run.add_option("--carrier-library", network.library,
                 "Library that carries messages to other processes (default: that of the installation)");
  run.add_option("--domain", words.domain, "DDS domain, in place of that of the specification")
      ->check(CLI::Range(0, static_cast<int>(last_domain)));
  run.add_option("--interface", network.interface,
                 "Network interface, in place of that of the specification");
  run.add_option("--peers", network.peers,
                 "A,B: hosts of the other processes, in place of those of the specification")
      ->delimiter(',');
  run.add_option("--incarnation", words.incarnation,
                 "Number of this start of the process, greater than all before (default: the time in ns)")
      ->check(CLI::PositiveNumber);
  simulate.add_option("--network", network.conditions,
                      "Network between processes: delay=2ms,jitter=1ms,loss=0.1,duplicate=0.01,reorder=0.05 "
                      "(default: delay=1ms)");
}

/// Returns the mistake in the words; nullopt: there is none, and the options are filled.
[[nodiscard]] std::optional<Problem> interpret(const Words& words, RunOptions& options) {
  if (options.project.empty()) options.project = project_of_this_program();
  if (!words.duration.empty()) {
    options.duration = parse_duration(words.duration);
    if (!options.duration)
      return Problem{fmt::format("--for {}: expected a time such as 60s, 2min or 500ms", words.duration)};
  }
  if (!words.skip_to.empty()) {
    if (!words.controlled) return Problem{"--skip-to needs --controlled"};
    options.skip_to = parse_duration(words.skip_to);
    if (!options.skip_to)
      return Problem{fmt::format("--skip-to {}: expected a time such as 60s, 2min or 500ms", words.skip_to)};
    if (options.duration && *options.skip_to >= *options.duration)
      return Problem{
          fmt::format("--skip-to {}: the run ends after {} already (--for)", words.skip_to, words.duration)};
  }
  if (!words.record_limit.empty()) {
    const auto limit = parse_record_limit(words.record_limit);
    if (!limit)
      return Problem{
          fmt::format("--record-limit {}: expected a size such as 500MB or 100MBx5", words.record_limit)};
    options.record_limit = *limit;
  }
  if (words.domain >= 0) options.network.domain = words.domain;
  if (words.incarnation > 0) options.network.incarnation = words.incarnation;
  for (const std::string& assignment : words.parameters) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
      return Problem{fmt::format("--set {}: expected PATH=VALUE", assignment)};
    options.parameters.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
  for (const std::string& driver : words.drivers) {
    std::string error;
    const std::optional<DriverRequest> request = parse_driver(driver, error);
    if (!request) return Problem{fmt::format("--driver {}: {}", driver, error)};
    options.drivers.push_back(*request);
  }
  WorldOptions world = words.world;
  if (!words.simulation.empty()) {
    std::string error;
    if (!read_simulation_file(words.simulation, options, world, error)) return Problem{error};
  }
  if (!world.world.empty()) world.server.reset();  // a world file on the command line comes first
  if (world.world.empty() && !world.server) return std::nullopt;
  options.world = world;
  options.world->seed = options.seed;
  if (words.start.size() == 3) {
    options.world->start_x_m = words.start[0];
    options.world->start_y_m = words.start[1];
    options.world->start_heading_rad = words.start[2] * std::numbers::pi / 180;
  }
  return std::nullopt;
}

/// Takes the arguments of ROS 2 out of the command line: from each `--ros-args` to `--`, or to the end.
[[nodiscard]] std::optional<std::vector<std::string>> take_ros2_words(std::vector<char*>& words) {
  std::optional<std::vector<std::string>> taken;
  std::vector<char*> left;
  bool within = false;
  for (char* const word : words) {
    const std::string_view text = word;
    if (!within && text == ros2_flag) {
      within = true;
      if (!taken) taken.emplace();
    } else if (within && text == "--") {
      within = false;
    } else if (within) {
      taken->emplace_back(text);
    } else {
      left.push_back(word);
    }
  }
  words = std::move(left);
  return taken;
}

/// The net and the verdicts from which the controller was made.
[[nodiscard]] std::string about(const System& system) {
  std::string text =
      fmt::format("{}\nnet {}\nverification {}\n", system.name, system.net_hash, system.verification_hash);
  for (const VerifiedProperty& property : system.verdicts)
    text += fmt::format("  {}: {} ({})\n", property.name, property.verdict, property.method);
  text.pop_back();
  return text;
}

}  // namespace

std::optional<Duration> parse_duration(std::string text) {
  std::erase(text, ' ');
  const std::size_t unit_at = text.find_first_not_of("0123456789.eE+-");
  std::string_view unit = unit_at == std::string::npos ? "s" : std::string_view(text).substr(unit_at);
  struct Unit {
    std::string_view name;
    double in_ns;
  };
  constexpr std::array units{Unit{"s", 1e9},    Unit{"ms", 1e6}, Unit{"us", 1e3},  Unit{"ns", 1.0},
                             Unit{"min", 60e9}, Unit{"m", 60e9}, Unit{"h", 3600e9}};
  const std::optional<double> number = parse_number(std::string_view(text).substr(0, unit_at));
  for (const Unit& known : units) {
    if (known.name != unit || !number || *number < 0) continue;
    const double nanoseconds = std::round(*number * known.in_ns);
    if (nanoseconds > 9e18) return std::nullopt;
    return Duration(static_cast<Duration::rep>(nanoseconds));
  }
  return std::nullopt;
}

std::optional<RunOptions::Limit> parse_record_limit(std::string text) {
  constexpr std::uint32_t segments_of_all = 4;
  std::erase(text, ' ');
  RunOptions::Limit limit{.segment_bytes = 0, .segments = segments_of_all};
  const std::size_t times = text.find('x');
  if (times != std::string::npos) {
    const std::optional<double> count = parse_number(std::string_view(text).substr(times + 1));
    if (!count || *count < 2 || *count > 1e6 || *count != std::floor(*count)) return std::nullopt;
    limit.segments = static_cast<std::uint32_t>(*count);
    text.resize(times);
  }
  const std::size_t unit_at = text.find_first_not_of("0123456789.");
  const std::string_view unit = unit_at == std::string::npos ? "B" : std::string_view(text).substr(unit_at);
  const std::optional<double> number = parse_number(std::string_view(text).substr(0, unit_at));
  struct Unit {
    std::string_view name;
    double bytes;
  };
  for (const Unit& known :
       {Unit{"B", 1}, Unit{"kB", 1e3}, Unit{"MB", 1e6}, Unit{"GB", 1e9}, Unit{"TB", 1e12}}) {
    if (known.name != unit || !number || *number <= 0) continue;
    const double bytes = *number * known.bytes / (times == std::string::npos ? segments_of_all : 1);
    if (bytes < 1 || bytes > 1e18) return std::nullopt;
    limit.segment_bytes = static_cast<std::uint64_t>(bytes);
    return limit;
  }
  return std::nullopt;
}

std::variant<CommandLine, int> parse_command_line(const System& system, int argc, char** argv) {
  CommandLine line;
  Words words;
  CLI::App app(fmt::format("The controller of {}, generated by Tessera.", system.name));
  app.footer(
      "Example: controller simulate --for 60s --seed 1 --record run.tsr --set v=0.3\n"
      "Exit codes: 0 ended as asked, 1 failed or could not start, 2 usage, 130 interrupted.");
  app.require_subcommand(1);
  app.set_version_flag("--about", about(system), "Say which net this is and what was verified of it");
  app.set_config("--config", "", "Read options from this file (INI or TOML)");
  CLI::App* simulate =
      app.add_subcommand("simulate", "Simulated clock: deterministic from the seed, as fast as possible");
  CLI::App* run = app.add_subcommand(
      "run", "Real time, a thread per subsystem; with --world or --simulated the robot is simulated");
  for (CLI::App* command : {simulate, run}) {
    command->fallthrough();
    command->configurable();
    describe_common(*command, line, words);
  }
  describe_network(*run, *simulate, line.options.network, words);
  run->add_flag(
      "--no-monitor", words.unwatched,
      "Run without a control socket: `tessera top`, `set` and `emergency-stop` cannot reach this run");
  run->add_flag("!--no-guardian", line.options.guardian,
                "No guardian process, for debuggers that stop the controller (docs/reference/safety.md)");
  run->add_flag(
      "--managed", line.managed,
      "A managed node of ROS 2, named after the system, in whose run nothing moves unless it is active "
      "(docs/use/ros2.md)");
  run->add_option("--orders", line.options.orders)->group("");  // from the managed node to its run
  run->add_flag("--simulated", line.options.simulated_drivers,
                "Simulated drivers in place of the real ones; a --world implies it");
  bool unused = false;  // the words are taken away before
  run->add_flag(
      ros2_flag, unused,
      "Names and parameters as a launch file of ROS 2 gives them, up to -- or the end: -r FROM:=TO, "
      "-r __node:=NAME, -r __ns:=/SPACE, -p NAME:=VALUE, --params-file FILE (docs/use/ros2.md)");
  simulate->add_option("--scenario", line.options.scenario,
                       "Follow this run first (tessera verify --scenario), then run on freely");
  simulate->add_flag("--interleave", line.options.interleave,
                     "Subsystems take turns after every firing, drawn from the seed");
  simulate->add_option("--schedules", line.schedules,
                       "Run this many seeds from --seed on, interleaved; report the failures by kind");
  simulate->add_option("--jobs", line.jobs, "Schedules: processes at a time (default: one per core)")
      ->check(CLI::Range(1U, most_jobs));
  simulate->add_flag("--coverage", line.coverage,
                     "Schedules: the summary says how often each transition fired");
  simulate->add_option("--from", line.from,
                       "Run user code again on the inputs of this recording, and compare the results");
  simulate->add_option("--inputs", line.inputs,
                       "Take the values of real inputs from this recording; no device is used");
  simulate->add_flag("--realtime", line.options.realtime, "Not faster than the wall clock");
  simulate->add_option("--ros2-clock", line.options.ros2_clock,
                       "Publish the simulated time as /clock of ROS 2 on this network interface, for example "
                       "lo; it is then not faster than the wall clock (docs/use/ros2.md)");
  simulate->add_flag("--controlled", words.controlled,
                     "Can be watched, paused, stepped and slowed down while it runs (as the studio does)");
  simulate->add_flag("--paused", line.options.paused, "With --controlled: begin paused");
  simulate
      ->add_option("--speed", line.options.speed,
                   "With --controlled: simulated seconds a second; 0: as fast as possible")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  simulate->add_option("--skip-to", words.skip_to,
                       "With --controlled: as fast as possible up to this time; --speed and --paused count "
                       "from then on");
  std::vector<char*> argued(argv, argv + argc);
  line.options.ros2_arguments = take_ros2_words(argued);
  try {
    app.parse(static_cast<int>(argued.size()), argued.data());
  } catch (const CLI::ParseError& error) {
    const bool unreadable = dynamic_cast<const CLI::FileError*>(&error) != nullptr;
    return app.exit(error) == 0 ? 0 : unreadable ? 1 : 2;
  }
  if (line.options.ros2_arguments && !run->parsed()) {
    fmt::print(stderr, "error: {} is for `run`: a simulated run has no nodes of ROS 2\n", ros2_flag);
    return 2;
  }
  line.options.monitor = run->parsed() ? !words.unwatched : words.controlled;
  line.options.clock = run->parsed() ? RunOptions::Clock::steady : RunOptions::Clock::simulated;
  std::string unread;
  if (!words.parameter_file.empty() &&
      !read_parameter_file(words.parameter_file, line.options.parameters, unread)) {
    fmt::print(stderr, "error: {}\n", unread);
    return 1;
  }
  const std::optional<Problem> wrong = interpret(words, line.options);
  if (!wrong) return line;
  fmt::print(stderr, "error: {}\n", wrong->text);
  return 2;
}

}  // namespace tessera
