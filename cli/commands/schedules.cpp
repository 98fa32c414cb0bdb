#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/recordings/coverage.hpp"
#include "cli/terminal.hpp"
#include "project/files/files.hpp"
#include "project/process/death.hpp"
#include "statistics/results.hpp"
#include "statistics/table.hpp"

namespace tessera::cli {

using namespace project;

namespace fs = std::filesystem;
using statistics::Results;
using statistics::Seeds;

namespace {

constexpr int most_jobs = 4096;

struct ScheduleOptions : SimulatedRunOptions {
  std::uint64_t count = 0;  ///< of all parts
  std::string part;         ///< "3/20"; empty: all of it
  unsigned jobs = 0;        ///< processes at a time; 0: one per core
};

/// The command that repeats one of the runs, alone and recorded, when its seed is appended.
std::string reproduction(const ScheduleOptions& options) {
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

/// Options of the controller that do not change a run: paths of files, and the seed.
constexpr std::array not_of_the_runs{"--record", "--record-values", "--record-limit", "--summary",
                                     "--seed",   "--trace",         "--world-library"};

/// The value that counts: for a file its content, wherever it is.
std::string meaning_of(const std::string& value) {
  std::error_code ignored;
  return fs::is_regular_file(value, ignored) ? hash_of(content_of(value)) : value;
}

/// Everything on the command line that changes a run, by the names of the options.
std::map<std::string, std::string> settings_of(const Command& command) {
  constexpr std::size_t first_option = 2;  // after the program and `simulate`
  std::map<std::string, std::string> settings;
  for (std::size_t at = first_option; at < command.size(); ++at) {
    std::string name = command[at], value;
    if (const std::size_t equals = name.find('='); equals != std::string::npos) {
      value = name.substr(equals + 1);
      name.resize(equals);
    } else if (at + 1 < command.size() && !command[at + 1].starts_with("--")) {
      value = command[++at];
    }
    if (name == "--progress" || std::ranges::count(not_of_the_runs, name) > 0) continue;
    std::string& all = settings[name.substr(name.find_first_not_of('-'))];
    all += (all.empty() ? "" : " ") + (value.empty() ? "yes" : meaning_of(value));
  }
  return settings;
}

/// The results with the fields that only this command knows; throws std::runtime_error if there are none.
Results read(const fs::path& summary) {
  Result<Results> counts = statistics::parse_counts(content_of(summary));
  if (!counts) throw std::runtime_error(fmt::format("{} {}", summary.string(), counts.problem()));
  return std::move(*counts);
}

std::string dead(const Exit& exit) {
  const std::string death = describe_death(exit, {});
  return death.empty() ? "the controller left no results" : death;
}

/// Whether the part can be read; prints the mistake.
bool is_part(const std::string& part) {
  if (part.empty() || statistics::parse_part(part)) return true;
  complain(fmt::format("--part {}: expected a part such as 3/20, the third of twenty", part));
  return false;
}

/// Runs the schedules, and writes and prints the failures, their numbers, and their probabilities. command: the
/// controller's, of one run. Returns the exit code: 0 none failed, 1 some did, 128 + signal: interrupted.
int run_schedules(const Controller& controller, const ScheduleOptions& options, Command command) {
  const Seeds whole{options.seed, options.seed + options.count};
  if (whole.end < whole.begin)
    return complain("there are not so many seeds: the last one would be beyond 2^64"), usage;
  const statistics::Part part =
      options.part.empty() ? statistics::Part{} : statistics::parse_part(options.part).value();
  const Seeds seeds = statistics::seeds_of(part, whole);
  const std::map<std::string, std::string> settings = settings_of(command);
  *std::next(std::ranges::find(command, "--seed")) = std::to_string(seeds.begin);
  command.insert(command.end(), {"--schedules", std::to_string(seeds.count())});
  if (options.jobs > 0) command.insert(command.end(), {"--jobs", std::to_string(options.jobs)});
  if (!options.coverage.empty()) command.emplace_back("--coverage");
  const RunFiles files = run_files(options);
  const Exit exit = run(command);
  if (!fs::exists(files.summary)) {
    // A controller that could not start has printed why.
    if (exit.code == 0 || exit.code > 128) complain(dead(exit));
    return exit.code == 0 ? failed : exit.code;
  }
  Results results = read(files.summary);
  results.whole = whole;
  results.parts = part.of;
  results.again = reproduction(options);
  results.identity.specification = hash_of(controller.specification.diagnostics.whole_text());
  results.identity.controller = hash_of(content_of(controller.program));
  results.identity.settings = settings;
  const std::string json = statistics::to_json(results);
  if (!options.json.empty()) write_output(options.json, json);
  const bool prints = options.json != "-" && options.coverage != "-";
  if (prints) fmt::print("{}", statistics::to_table(results));
  if (options.coverage.empty()) return exit.code;
  CoverageInput input(controller.specification);
  input.add_firings(files.summary.string(), results.identity.net, results.transitions, results.tried);
  report_coverage(input, options.coverage, prints);
  return exit.code;
}

int schedules_command(ScheduleOptions options) {
  if (!is_part(options.part)) return usage;
  auto prepared = prepare_simulated_run(options, "schedules", /*is_recorded=*/false, "1s");
  if (const int* const code = std::get_if<int>(&prepared)) return *code;
  auto& [controller, folder, command] = std::get<SimulatedRun>(prepared);
  return run_schedules(controller, options, std::move(command));
}

}  // namespace

void add_schedules(CommandLine& app) {
  Subcommand command =
      app.add("schedules", "Run many interleavings of the simulated controller, and count the failures");
  ScheduleOptions& options = command.runs(schedules_command);
  command
      .option("count", options.count,
              "How many, with seeds from --seed on, of 1 s or --for each; nothing is recorded")
      .required()
      .within(1, std::numeric_limits<int>::max());
  declare_simulated_run_options(command, options);
  command.option("--part", options.part, "Only one part of the seeds, 3/20");
  command.option("--jobs", options.jobs, "Processes at a time (default: one per core)").within(1, most_jobs);
  command.footer(
      "Ends with 0 if no run failed, 1 if one did. `tessera simulate --interleave --seed N` repeats and\n"
      "records one of them.\n"
      "Examples:\n"
      "  tessera schedules 1000 --for 1s      is there an interleaving that goes wrong?\n"
      "  tessera schedules 1000000 robot --part 3/20 --json part3.json   see `tessera merge`\n"
      "  tessera schedules 100 --coverage     which parts has no run reached?");
}

}  // namespace tessera::cli
