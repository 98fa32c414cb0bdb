#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bag/bag_reader.hpp"
#include "cli/commands/commands.hpp"
#include "cli/recordings/bags.hpp"
#include "cli/recordings/coverage.hpp"
#include "cli/recordings/film.hpp"
#include "cli/recordings/legality_check.hpp"
#include "cli/recordings/legality_text.hpp"
#include "cli/recordings/recording_summary.hpp"
#include "cli/recordings/times_commands.hpp"
#include "cli/terminal.hpp"
#include "project/files/file_names.hpp"
#include "project/files/state_folder.hpp"
#include "project/verification/pipeline.hpp"
#include "replay/events.hpp"
#include "replay/legality.hpp"
#include "replay/perfetto.hpp"
#include "replay/statistics.hpp"
#include "tessera/nearest.hpp"
#include "tessera/printable.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

using namespace project;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* all_values = "*";
constexpr const char* usual_recording = ".tessera/last/recording.tsr";

struct ReplayOptions {
  std::vector<std::string> recordings;
  fs::path project;  ///< whose last run is read; empty: of none
  std::string recording = usual_recording, spec, subsystem, transition, csv, perfetto, json, mcap, coverage;
  double from_s = 0, to_s = HUGE_VAL;
  std::size_t last = 0;
  bool check = false, print = false, ages = false;
  FilmOptions film;
  std::string values;  ///< buffers whose path contains this; all_values; empty: none
};

// ---------------------------------------------------------------------------------------------- the events

replay::Selection selection_of(const ReplayOptions& options) {
  replay::Selection selection{options.from_s,    options.to_s,       options.last,
                              options.subsystem, options.transition, options.print || options.values.empty(),
                              std::nullopt};
  if (!options.values.empty()) selection.values = options.values == all_values ? "" : options.values;
  return selection;
}

void write_csv(const Recording& recording, const ReplayOptions& options) {
  std::ostringstream text;
  if (!options.values.empty() && !options.print) {
    replay::write_values_csv(recording, selection_of(options), text);
  } else {
    replay::Selection selection = selection_of(options);
    if (options.values.empty()) selection.values = "";
    replay::write_csv(recording, selection, text);
  }
  write_output(options.csv, text.str());
}

void write_perfetto_file(const Recording& recording, const std::string& file) {
  std::ostringstream text;
  replay::write_perfetto(recording, text);
  write_output(file, text.str());
}

// ---------------------------------------------------------------------------------------------- check

/// The specification of a recording: of the project that was named, else in its folder or in one above. Empty:
/// there is none.
std::string specification_if_any(const ReplayOptions& options) {
  if (!options.spec.empty()) return options.spec;
  // The recordings of a project that cannot be written are elsewhere.
  if (fs::path file = options.project / file_names::specification;
      !options.project.empty() && fs::exists(file))
    return file.string();
  for (fs::path folder = fs::absolute(options.recording).parent_path();; folder = folder.parent_path()) {
    if (fs::path file = folder / file_names::specification; fs::exists(file)) return file.string();
    if (folder == folder.parent_path()) return {};
  }
}

std::string specification_of(const ReplayOptions& options) {
  std::string found = specification_if_any(options);
  if (!found.empty()) return found;
  throw std::runtime_error("no specification is beside '" + options.recording +
                           "' or above it; name the one that the controller was generated from with --spec");
}

bool known_subsystem(const Recording& recording, const std::string& path) {
  std::vector<std::string> names = recording.instances;
  names.emplace_back("system");
  if (path.empty() || std::ranges::count(names, path) > 0) return true;
  complain(with_hint("the recording has no subsystem '" + path + "'", did_you_mean(path, names)));
  return false;
}

bool known_values(const Recording& recording, const std::string& wanted) {
  if (wanted.empty() || wanted == all_values) return true;
  std::vector<std::string> names;
  for (const Recording::Buffer& buffer : recording.buffers) {
    if (buffer.path.find(wanted) != std::string::npos) return true;
    names.push_back(buffer.path);
    names.push_back(buffer.path.substr(buffer.path.rfind('.') + 1));
  }
  complain(
      with_hint("no buffer of the recording has '" + wanted + "' in its path", did_you_mean(wanted, names)));
  return false;
}

/// The last run of the project in this folder, wherever its files are.
std::string last_recording(const fs::path& project) {
  const fs::path kept = state_folder(fs::canonical(project)) / "last";
  for (const fs::path& last : {(project / usual_recording).parent_path().lexically_normal(), kept}) {
    if (fs::exists(last / file_names::recording)) return (last / file_names::recording).string();
    if (fs::exists(last / file_names::deployment)) return last.string();
  }
  return usual_recording;
}

/// The joint summary of all recordings, which must be of one net.
int coverage_command(const ReplayOptions& options) {
  const std::optional<Specification> specification = read(specification_of(options), terminal());
  if (!specification) return exit_code_without_net();
  CoverageInput input(*specification);
  for (const std::string& recording : options.recordings) input.add_file(recording);
  report_coverage(input, options.coverage, options.coverage != "-");
  return ok;
}

int film_command(const ReplayOptions& options) {
  FilmOptions film = options.film;
  film.recording = options.recording;
  film.spec = options.spec;
  film.from_s = options.from_s;
  film.to_s = options.to_s;
  return make_film(film);
}

/// The check of the recordings of a deployed system's processes.
int check_command(const ReplayOptions& options) {
  std::vector<Recording> recordings;
  for (const std::string& file : options.recordings) {
    std::string error;
    std::optional<ReadRun> one = read_run(file, error);
    if (!one) return complain(error), usage;
    if (!one->differences.empty()) return failed;
    recordings.push_back(std::move(one->recording));
  }
  const std::optional<replay::Legality> legality = check_against(specification_of(options), recordings);
  if (!legality) return failed;
  if (options.json != "-") print_verdict(*legality, recordings);
  if (!options.json.empty())
    write_output(options.json, json{{"check", json_of(*legality, recordings)}}.dump(2) + "\n");
  return exit_code_of(legality->verdict);
}

/// Only --check accepts several recordings.
bool only_checks(const ReplayOptions& options) {
  return options.check && !options.print && options.values.empty() && options.csv.empty() &&
         options.perfetto.empty() && options.mcap.empty();
}

/// Then a recording may be of any length.
bool only_writes_bag(const ReplayOptions& options) {
  return !options.mcap.empty() && !options.check && !options.print && options.values.empty() &&
         options.csv.empty() && options.perfetto.empty() && options.json.empty() && options.subsystem.empty();
}

std::vector<std::string> all_recordings(const std::vector<std::string>& given) {
  std::vector<std::string> all;
  for (const std::string& one : given) std::ranges::move(recordings_of(one), std::back_inserter(all));
  return all;
}

int replay_command(ReplayOptions options) {
  if (options.recordings.empty()) {
    options.project = ".";
    options.recordings.push_back(last_recording(options.project));
  }
  for (std::string& given : options.recordings) {
    if (!fs::exists(fs::path(given) / file_names::specification)) continue;
    if (options.project.empty()) options.project = given;
    given = last_recording(given);
  }
  options.recordings = all_recordings(options.recordings);
  if (options.recordings.empty())
    return complain("there is no recording in this folder"), options.check ? usage : failed;
  options.recording = options.recordings.front();
  if (!options.coverage.empty()) return coverage_command(options);
  if (options.ages) return ages_command({options.recordings, specification_of(options), options.json});
  if (options.recordings.size() > 1 && options.film.file.empty() && only_checks(options))
    return check_command(options);
  if (options.recordings.size() > 1)
    return complain("several recordings are read together with --check alone, or with --coverage or --ages"),
           usage;
  if (!options.film.file.empty()) return film_command(options);
  if (only_writes_bag(options) && !bag::is_bag(options.recording) &&
      write_bag_of_file(options.recording, specification_if_any(options), options.mcap))
    return ok;
  std::string error;
  const std::optional<ReadRun> run = read_run(options.recording, error);
  if (!run) return complain(error), options.check ? usage : failed;
  const Recording* const recording = &run->recording;
  if (!known_subsystem(*recording, options.subsystem)) return usage;
  json result;
  int exit_code = ok;
  const bool to_output = options.json == "-" || options.csv == "-" || options.perfetto == "-";
  const bool show =
      options.print || (!options.values.empty() && options.csv.empty() && options.perfetto.empty());
  const bool other =
      options.check || show || !options.csv.empty() || !options.perfetto.empty() || !options.mcap.empty();
  if (!options.values.empty() && recording->buffers.empty())
    return complain("the recording holds no values of buffers; record with --record-values small or all");
  if (!known_values(*recording, options.values)) return usage;
  if (!options.csv.empty()) write_csv(*recording, options);
  if (!options.perfetto.empty()) write_perfetto_file(*recording, options.perfetto);
  if (!options.mcap.empty()) write_bag(*recording, specification_if_any(options), options.mcap);
  if (show) replay::print_events(*recording, selection_of(options), std::cout);
  if (!other || !options.json.empty()) {
    const std::vector<replay::SubsystemStatistics> all = replay::statistics_of(*recording);
    result = summary_json(*recording, all);
    if (!other && !to_output) print_summary(*recording, all);
  }
  if (options.check) {
    const std::optional<replay::Legality> legality = check_against(specification_of(options), {*recording});
    if (!legality) return failed;
    exit_code = run->differences.empty() ? exit_code_of(legality->verdict) : failed;
    result["check"] = json_of(*legality, {&*recording, 1});
    if (lacks_beginning(*recording)) result["recorded_from_s"] = recorded_from_s(*recording);
    if (!to_output) print_verdict(*legality, {&*recording, 1});
  }
  if (!options.json.empty()) write_output(options.json, result.dump(2) + "\n");
  if (other && lacks_beginning(*recording)) {
    std::cout.flush();  // the note comes last, also where both go into one file
    std::fflush(stdout);
    fmt::print(stderr, "note: {}\n", note_on_beginning(*recording));
  }
  return exit_code;
}

}  // namespace

void add_replay(CommandLine& app) {
  Subcommand command =
      app.add("replay", "Read a recording: what ran when, how regularly, and whether it was legal");
  ReplayOptions& options = command.runs(replay_command);
  command.option("recording", options.recordings,
                 std::string("Recording of a run, or a project: its last one (default: ") + usual_recording +
                     "); several with --coverage and --ages, or with --check those of a deployed system");
  command.flag("--check", options.check,
               "Play it on the net of its specification: is it a legal firing sequence?");
  command.option("--spec", options.spec, "That specification (default: beside the recording or above)");
  command.flag("--coverage", options.coverage, shown_only,
               "Show the parts of the net that no recording, or result of schedules, has reached; "
               "--coverage=FILE writes JSON, too");
  Option ages = command.flag("--ages", options.ages,
                             "How old the readings were that commands acted on, beside the proved bounds");
  command.flag("--print", options.print, "Print the events");
  command.flag("--values", options.values, all_values,
               "Print the values of buffers, or of those whose path contains TEXT (--values=TEXT); with "
               "--csv a row per change and a column per field");
  command.option("--from", options.from_s, "Events, or a film, from this time on, in seconds");
  command.option("--to", options.to_s, "Events, or a film, up to this time, in seconds");
  command.option("--last", options.last, "Only this many events, the last ones");
  command.option("--subsystem", options.subsystem, "Events of this subsystem, or of `system`");
  command.option("--containing", options.transition, "Events whose text contains this: t6, .snd.motion");
  command.option("--csv", options.csv, "Write the events as CSV (- is standard output)");
  command.option("--to-perfetto", options.perfetto, "Write a trace for ui.perfetto.dev");
  command.option("--mcap", options.mcap, "Write a bag for the tools of ROS 2 (docs/reference/recordings.md)");
  command.option("--json", options.json, "Write summary and check as JSON (- is standard output)");
  Option film =
      command.option("--film", options.film.file,
                     "Draw the simulated run: FILE.png (animated) or FILE.y4m; with ffmpeg also .mp4, "
                     ".webm and .gif");
  command
      .option("--camera", options.film.camera, "Films: a camera of the world (default: all robots in view)")
      .needs(film);
  command.option("--speed", options.film.speed, "Films: speed, as a multiple of that of the run").needs(film);
  command.option("--size", options.film.size, "Films: WIDTHxHEIGHT in pixels").shows_default().needs(film);
  for (const char* other : {"--check", "--print", "--values", "--csv", "--to-perfetto", "--mcap", "--json",
                            "--coverage", "--last", "--subsystem", "--containing"})
    film.excludes(command.declared(other));
  for (const char* other :
       {"--check", "--print", "--values", "--csv", "--to-perfetto", "--mcap", "--coverage", "--film",
        "--last", "--subsystem", "--containing", "--from", "--to"})
    ages.excludes(command.declared(other));
  command.footer(
      "Without other options: a summary. --check ends with 0 if the run is legal, 1 if it is not, 2 if no\n"
      "recording can be read, 3 if events are missing. --ages ends with 1 if a time exceeds its bound.\n"
      "Example: tessera replay --check\n"
      "         tessera replay flight.tsr --print --subsystem robot.control --from 12.5 --to 13\n"
      "         tessera replay --values=control.motion --csv motion.csv\n"
      "         tessera replay --to-perfetto run.json\n"
      "         tessera replay --mcap run.mcap && tessera replay --check run.mcap\n"
      "         tessera replay --film run.mp4 --speed 2\n"
      "         tessera replay --coverage monday.tsr tuesday.tsr all.json\n"
      "         tessera replay --ages monday.tsr tuesday.tsr");
}

}  // namespace tessera::cli
