#include "cli/schedules.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <string_view>

#include "cli/coverage.hpp"
#include "cli/launch.hpp"
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

}  // namespace

bool is_part(const std::string& part) {
  if (part.empty() || statistics::parse_part(part)) return true;
  complain(fmt::format("--part {}: expected a part such as 3/20, the third of twenty", part));
  return false;
}

int run_schedules(const Controller& controller, const LaunchOptions& options,
                  const ScheduleOptions& schedules, Command command) {
  const Seeds whole{options.seed, options.seed + schedules.count};
  if (whole.end < whole.begin)
    return complain("there are not so many seeds: the last one would be beyond 2^64"), usage;
  const statistics::Part part =
      schedules.part.empty() ? statistics::Part{} : statistics::parse_part(schedules.part).value();
  const Seeds seeds = statistics::seeds_of(part, whole);
  const std::map<std::string, std::string> settings = settings_of(command);
  *std::next(std::ranges::find(command, "--seed")) = std::to_string(seeds.begin);
  command.insert(command.end(), {"--schedules", std::to_string(seeds.count())});
  if (schedules.jobs > 0) command.insert(command.end(), {"--jobs", std::to_string(schedules.jobs)});
  if (!schedules.coverage.empty()) command.emplace_back("--coverage");
  if (options.debug) return print_debugger_line(command);
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
  results.again = schedules.again;
  results.identity.specification = hash_of(controller.specification.diagnostics.text());
  results.identity.controller = hash_of(content_of(controller.program));
  results.identity.settings = settings;
  const std::string json = statistics::to_json(results);
  if (!schedules.results.empty()) write_output(schedules.results, json);
  if (!schedules.json.empty()) write_output(schedules.json, json);
  const bool prints = schedules.json != "-" && schedules.results != "-" && schedules.coverage != "-";
  if (prints) fmt::print("{}", statistics::to_table(results));
  if (schedules.coverage.empty()) return exit.code;
  CoverageInput input(controller.specification);
  input.add_firings(files.summary.string(), results.identity.net, results.transitions, results.tried);
  report_coverage(input, schedules.coverage, prints);
  return exit.code;
}

}  // namespace tessera::cli
