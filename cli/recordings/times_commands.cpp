#include "cli/recordings/times_commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "cli/line_difference.hpp"
#include "cli/recordings/ages_text.hpp"
#include "cli/recordings/bags.hpp"
#include "cli/recordings/learned_takes.hpp"
#include "cli/terminal.hpp"
#include "project/build/user_sources.hpp"
#include "project/packaging/scratch_folder.hpp"
#include "project/verification/pipeline.hpp"
#include "replay/times/call_durations.hpp"
#include "replay/times/measured_ages.hpp"
#include "spec/parser.hpp"
#include "tessera/recording.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;

/// Tells the reader of the figures what the recording lacks.
void note(const Recording& recording, const std::string& file) {
  const auto say = [&](const std::string& what) { fmt::print(stderr, "note: {}: {}\n", file, what); };
  if (lacks_beginning(recording)) say(note_on_beginning(recording));
  if (recording.truncated) say("it is cut off at its end");
  if (recording.lost > 0)
    say(fmt::format("{} events are missing in it; times that depend on them are left out", recording.lost));
}

struct Input {
  project::Specification specification;
  std::vector<Recording> recordings;
};

/// nullopt: the reason has been printed, and `code` is the exit code.
std::optional<Input> read_input(const TimesOptions& options, int& code) {
  std::optional<project::Specification> specification = project::read(options.spec, terminal());
  if (!specification) return code = exit_code_without_net(), std::nullopt;
  Input input{std::move(*specification), {}};
  for (const std::string& file : options.recordings) {
    std::string error;
    std::optional<ReadRun> run = read_run(file, error);
    if (!run) return complain(error), code = usage, std::nullopt;
    if (run->recording.system != input.specification.model.system)
      return code = complain(fmt::format(
                 "{} is of the system '{}', and {} has the system '{}': name the specification it was made "
                 "with by --spec",
                 file, run->recording.system, input.specification.file.string(),
                 input.specification.model.system)),
             std::nullopt;
    note(run->recording, file);
    input.recordings.push_back(std::move(run->recording));
  }
  return input;
}

/// The net may have changed since; then subsystems, behaviours and channels are those with the same names.
void note_on_other_nets(const Input& input, const std::vector<std::string>& files) {
  const std::optional<project::Nets> nets = project::build(input.specification, terminal());
  if (!nets) return;
  const std::string hash = verify::hash_of(nets->flat);
  for (std::size_t index = 0; index < files.size(); ++index)
    if (input.recordings[index].net_hash != hash)
      fmt::print(
          stderr,
          "note: {}: it is of another version of the net than {}; parts with the same names are compared\n",
          files[index], input.specification.file.string());
}

/// Prints the mistakes that the changed files would have. The files are read as a whole, so they stand in a folder
/// of their own.
bool is_correct(const TakesEdit& edit, const fs::path& specification) {
  const project::ScratchFolder folder;
  for (const TakesEdit::File& file : edit.files) {
    if (file.name.empty()) continue;
    const fs::path path = folder.path() / file.name;
    fs::create_directories(path.parent_path());
    write_output(path.string(), file.after);
  }
  diagnostics::Diagnostics after(specification.string(), edit.files.front().after, folder.path());
  if (spec::parse(after)) return true;
  terminal().say(after);
  return false;
}

}  // namespace

int ages_command(const TimesOptions& options) {
  int code = ok;
  const std::optional<Input> input = read_input(options, code);
  if (!input) return code;
  note_on_other_nets(*input, options.recordings);
  const std::vector<replay::AgesOfChain> all = replay::ages_in(input->recordings, input->specification.model);
  if (all.empty())
    return complain(
        "no values lead from a receptor over a control subsystem to an effector of the same agent");
  if (options.json != "-") {
    fmt::print("{}", ages_text(all, options.recordings));
    std::fflush(stdout);
  }
  if (!options.json.empty())
    write_output(options.json,
                 nlohmann::json{{"ages", replay::ages_json(all, options.recordings)}}.dump(2) + "\n");
  return std::ranges::any_of(all, &replay::AgesOfChain::exceeds) ? failed : ok;
}

int takes_command(const TimesOptions& options) {
  int code = ok;
  const std::optional<Input> input = read_input(options, code);
  if (!input) return code;
  if (!(options.margin_percent >= 0 && options.margin_percent < 100))
    return complain("--margin is a part of the time in percent, from 0 to less than 100"), usage;
  replay::DurationsOfBehaviours measured;
  for (std::size_t index = 0; index < input->recordings.size(); ++index) {
    if (input->recordings[index].clock == "simulated")
      fmt::print(
          stderr,
          "note: {}: a simulated run: its calls take the times that the specification says, so nothing is "
          "learned from it\n",
          options.recordings[index]);
    else
      add_durations(input->recordings[index], measured);
  }
  const std::vector<LearnedTakes> all =
      learned_takes(input->specification.model, measured, options.margin_percent / 100);
  if (std::ranges::none_of(all, [](const LearnedTakes& one) { return one.measured.count > 0; }))
    return complain(
        "no recording tells how long a call takes: record a real run (tessera run) with "
        "--record-values small; tessera run --world tells the times on this computer");
  const diagnostics::Diagnostics& before = input->specification.diagnostics;
  const TakesEdit edit = with_takes(before, all);
  if (!options.json.empty())
    write_output(
        options.json,
        nlohmann::json{{"takes", takes_json(all)}, {"margin_percent", options.margin_percent}}.dump(2) +
            "\n");
  const bool is_shown = options.json != "-";
  if (is_shown)
    fmt::print("{}margin: {:g} % below the shortest and above the longest call\n", takes_table(all),
               options.margin_percent);
  for (const std::string& other : edit.elsewhere) fmt::print(stderr, "write it there yourself: {}\n", other);
  if (!edit.problem.empty()) return complain("the specification cannot be changed: " + edit.problem);
  if (!is_correct(edit, input->specification.file))
    return complain("the specification with these times would not be correct, so nothing was changed");
  std::string difference;
  std::vector<project::Replacement> replacements;
  for (const TakesEdit::File& file : edit.files) {
    const fs::path path = file.name.empty() ? input->specification.file : before.folder() / file.name;
    if (const std::string lines = line_difference(file.before, file.after); !lines.empty())
      difference += fmt::format("\n{}\n{}", path.string(), lines);
    replacements.push_back({path, file.before, file.after});
  }
  if (difference.empty()) {
    if (is_shown) fmt::print("{}: nothing to change\n", input->specification.file.string());
    return ok;
  }
  if (is_shown) fmt::print("{}", difference);
  if (!options.write) {
    if (is_shown) fmt::print("--write writes this\n");
    return ok;
  }
  if (const auto problem = project::replace_together(input->specification.project, replacements))
    return complain("nothing was changed: " + *problem);
  if (is_shown) fmt::print("written\n");
  return ok;
}

}  // namespace tessera::cli
