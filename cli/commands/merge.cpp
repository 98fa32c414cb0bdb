#include "statistics/merge.hpp"

#include <fmt/core.h>

#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/outputs.hpp"
#include "cli/terminal.hpp"
#include "project/files/files.hpp"
#include "statistics/table.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

namespace {

struct MergeOptions {
  std::vector<std::string> files;
  std::string json;
  bool other_builds = false;
};

int merge_command(const MergeOptions& options) {
  check_replaceable(options.json, "{");
  std::vector<statistics::NamedResults> all;
  for (const std::string& file : options.files) {
    Result<statistics::Results> results = statistics::parse_results(project::content_of(file));
    if (!results) return complain(fmt::format("{} {}", file, results.problem()));
    all.push_back({file, std::move(*results)});
  }
  const Result<statistics::Results> merged = statistics::merge(all, options.other_builds);
  if (!merged) return complain(merged.problem());
  if (!options.json.empty()) write_output(options.json, statistics::to_json(*merged));
  if (options.json != "-") fmt::print("{}", printable(statistics::to_table(*merged)));
  const std::vector<std::string> missing = statistics::missing_parts(*merged);
  constexpr std::size_t most_shown = 20;
  for (std::size_t index = 0; index < missing.size(); ++index)
    if (index < most_shown) fmt::print(stderr, "missing: {}\n", printable(missing[index]));
  if (missing.size() > most_shown)
    fmt::print(stderr, "missing: ... and {} more\n", missing.size() - most_shown);
  if (merged->failed > 0) return failed;
  return missing.empty() ? ok : unknown;
}

}  // namespace

void add_merge(CommandLine& app) {
  Subcommand command = app.add("merge", "Join the results of schedules that were run in parts");
  MergeOptions& options = command.runs(merge_command);
  command.option("files", options.files, "Files of `tessera schedules N --json FILE`")
      .required()
      .existing_file();
  command.option("--json", options.json, "Write them as one file of the same kind (- is standard output)");
  command.flag("--other-builds", options.other_builds,
               "The controllers were built apart, from the same sources: count them as one");
  command.footer(
      "Parts of different nets, settings or programs are refused, and so is a seed that is in two files.\n"
      "Ends with 0 if no run failed, 1 if one did, 3 if none did and parts are missing.\n"
      "Example: tessera schedules 1000000 --part 3/20 --json part3.json   (on each machine)\n"
      "         tessera merge part*.json --json all.json");
}

}  // namespace tessera::cli
