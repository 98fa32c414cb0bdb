#include "cli/outcome.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "cli/outputs.hpp"
#include "cli/path_plot.hpp"
#include "cli/recordings/film.hpp"
#include "cli/recordings/overtime.hpp"
#include "cli/terminal.hpp"
#include "replay/times/measured_ages.hpp"
#include "tessera/judgement.hpp"
#include "tessera/printable.hpp"
#include "tessera/result.hpp"

namespace tessera::cli {

using namespace project;

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

json read_summary(const fs::path& file) {
  std::ifstream stream(file);
  json summary = json::parse(stream, nullptr, false);
  if (summary.is_discarded())
    throw std::runtime_error("the controller left no readable summary in " + file.string());
  return summary;
}

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw std::runtime_error(result.problem());
  return std::move(*result);
}

report::DrivenPath drive_over(const sim::Track& floor, sim::Trace trace, bool is_whole) {
  report::DrivenPath drive;
  drive.is_whole = is_whole;
  drive.floor = floor;
  drive.trace = std::move(trace);
  drive.line = sim::skeleton(drive.floor);
  if (!drive.line.points.empty()) drive.metrics = sim::measure(drive.line, drive.trace);
  return drive;
}

void put_verdict(const json& check, report::JudgedCurve& curve) {
  curve.verdict = check.value("verdict", "");
  curve.text = check.value("text", "");
  curve.detail = check.value("detail", "");
  if (curve.verdict == "failed" && check.contains("time_s"))
    curve.failed_s = check.at("time_s").get<double>();
}

std::vector<report::JudgedCurve> judged_in(const RunOutcome& outcome) {
  std::vector<report::JudgedCurve> all;
  const json checks = outcome.summary.value("checks", json::array());
  for (const json& written : outcome.curves) {
    report::JudgedCurve& curve = all.emplace_back();
    curve.name = written.value("name", "");
    curve.is_check = written.value("check", false);
    curve.is_truth = written.value("truth", false);
    curve.every_s = written.value("every_s", curve.every_s);
    curve.unit = written.value("unit", "");
    if (written.contains("limit")) curve.limit = written.at("limit").get<double>();
    for (const json& span : written.value("spans", json::array()))
      curve.spans.push_back(
          span.is_null() ? std::nullopt
                         : std::optional(std::pair(span.at(0).get<double>(), span.at(1).get<double>())));
    // The curves of the checks come first, in their order.
    if (curve.is_check && all.size() <= checks.size()) put_verdict(checks[all.size() - 1], curve);
  }
  // Those of what the run used have none.
  const auto drawn = static_cast<std::size_t>(std::ranges::count_if(all, &report::JudgedCurve::is_check));
  for (std::size_t at = drawn; at < checks.size(); ++at) {
    report::JudgedCurve& curve = all.emplace_back();
    curve.name = checks[at].value("name", "");
    curve.is_check = true;
    put_verdict(checks[at], curve);
  }
  return all;
}

/// A report without a picture of the world is better than none.
void put_poster(const std::string& recording, report::ReportInput& input) {
  if (!input.paths || !input.paths->has_poses) return;
  constexpr int width = 1000, height = 562;
  try {
    input.poster = report::Poster{poster_of(recording, world_of_recording(recording, ""), width, height), 0};
  } catch (const std::exception& error) {
    input.why_no_poster = error.what();
  }
}

report::ReportInput report_input(RunOutcome outcome, const verify::Report& verification) {
  std::string error;
  report::ReportInput input;
  std::optional<Recording> recording = read_recording(outcome.recording.string(), error);
  if (!recording) throw std::runtime_error(error);
  input.recording = std::move(*recording);
  input.drive = std::move(outcome.drive);
  input.paths = std::move(outcome.paths);
  input.floor = std::move(outcome.floor);
  input.judged = judged_in(outcome);
  input.chains = std::move(outcome.chains);
  input.slow_calls = std::move(outcome.slow_calls);
  put_poster(outcome.recording.string(), input);
  input.simulated_s = outcome.summary.value("simulated_s", 0.0);
  input.wall_s = outcome.summary.value("wall_s", 0.0);
  input.firings = outcome.summary.value("firings", 0ULL);
  input.ended = outcome.summary.value("ended", "");
  for (const json& subsystem : outcome.summary.value("subsystems", json::array()))
    input.subsystems.push_back({subsystem.value("path", ""), subsystem.value("iterations", 0ULL),
                                subsystem.value("overruns", 0ULL), subsystem.value("errors", 0ULL)});
  for (const verify::PropertyResult& property : verification.properties)
    input.verdicts.push_back({property.name, name_of(property.verdict),
                              property.verdict == verify::Verdict::holds ? property.method : property.why});
  return input;
}

/// names: "rover, rover_2", shortened if there are many.
std::string several_robots(const std::string& names) {
  constexpr std::size_t longest = 80;
  const std::size_t comma = names.size() > longest ? names.rfind(',', longest) : std::string::npos;
  const std::string shown = comma == std::string::npos ? names : names.substr(0, comma) + ", ...";
  return "Several robots move in this world (" + shown +
         "): their way along the track is not measured. Name what you want to know under `measures`.";
}

/// Whether it is known how the robot kept to the line during the whole run.
bool measures_whole_drive(const RunOutcome& outcome) {
  return outcome.drive && outcome.drive->is_whole && !outcome.drive->line.points.empty();
}

}  // namespace

RunOutcome read_outcome(const Controller& controller, const LaunchOptions& options) {
  const Specification& specification = controller.specification;
  const RunFiles files = run_files(options);
  RunOutcome outcome;
  outcome.summary = read_summary(files.summary);
  outcome.recording = files.recording;
  if (outcome.summary.is_object()) {
    outcome.curves = outcome.summary.value("curves", json::array());
    outcome.summary.erase("curves");
  }
  outcome.slow_calls = slow_calls_of(outcome.summary);
  const std::optional<spec::Simulation>& simulation = specification.model.simulation;
  const bool has_world = simulation && !(simulation->world.empty() && options.world.empty());
  if (!has_world) return outcome;
  if (const std::optional<Floor> floor = floor_of(specification, options))
    outcome.floor = value_or_throw(sim::Track::load(floor->image.string(), floor->metres_per_pixel));
  outcome.paths = report::paths_in(files.recording.string(), outcome.floor ? &*outcome.floor : nullptr);
  if (outcome.paths->robots.size() > 1) outcome.robots = outcome.paths->names();
  if (outcome.floor && outcome.paths->trace)
    outcome.drive = drive_over(*outcome.floor, *std::exchange(outcome.paths->trace, std::nullopt),
                               !outcome.summary.contains("recorded_from_s"));
  return outcome;
}

std::string to_json(const RunOutcome& outcome) {
  json result = outcome.summary;
  if (measures_whole_drive(outcome)) {
    const sim::LineMetrics& line = outcome.drive->metrics;
    result["laps"] = line.laps;
    result["line_lost_s"] = line.line_lost_s;
    result["longest_loss_s"] = line.longest_loss_s;
    result["lateral_error_m"] = {{"mean", line.mean_error_m}, {"max", line.max_error_m}};
  }
  if (!outcome.robots.empty()) result["robots"] = outcome.robots;
  return result.dump(2) + "\n";
}

namespace {

// Only the first few subsystems of a fleet are printed; the JSON has all.
constexpr std::size_t shown_subsystems = 12;

void print_subsystems(const json& subsystems) {
  for (std::size_t index = 0; index < std::min(subsystems.size(), shown_subsystems); ++index) {
    const json& subsystem = subsystems[index];
    fmt::print("  {:<24} {:>8} iterations  {:>4} overruns  {:>4} errors\n", subsystem.value("path", ""),
               subsystem.value("iterations", 0ULL), subsystem.value("overruns", 0ULL),
               subsystem.value("errors", 0ULL));
  }
  if (subsystems.size() > shown_subsystems)
    fmt::print("  ... and {} more\n", subsystems.size() - shown_subsystems);
}

std::string ms_text(const json& chain, const char* name) {
  const auto found = chain.find(name);
  return found == chain.end() ? "" : fmt::format("{:.6g} ms", found->get<double>() * 1e3);
}

/// "joints to motors: age at most 79 ms measured, 81 ms proved; ..."
void print_chains(const json& chains) {
  const auto times = [](const json& chain, const char* what, const char* longest, const char* proved) {
    const std::string most = ms_text(chain, longest), bound = ms_text(chain, proved);
    if (most.empty()) return std::string();
    return fmt::format("{} at most {} measured, {} proved", what, most, bound.empty() ? "nothing" : bound);
  };
  for (const json& chain : chains) {
    const std::string age = times(chain, "age", "longest_age_s", "proved_age_s"),
                      reaction = times(chain, "; reaction", "longest_reaction_s", "proved_reaction_s");
    fmt::print("  {}: {}{}\n", printable(chain.value("name", "")),
               age.empty() ? "no command is based on a reading" : age, reaction);
  }
}

/// "97", "1.0", "0.03": a robot in real time must not read as one that stands still.
std::string speed_text(double factor) {
  if (factor >= 2) return fmt::format("{:.0f}", factor);
  return factor >= 0.1 ? fmt::format("{:.1f}", factor) : fmt::format("{:.1g}", factor);
}

}  // namespace

void print(const RunOutcome& outcome) {
  const json& summary = outcome.summary;
  if (outcome.drive) fmt::print("{}", path_plot(outcome.drive->floor, outcome.drive->trace));
  fmt::print("{:.1f} s in {:.2f} s ({} x real time), {} firings, ended by: {}\n",
             summary.value("simulated_s", 0.0), summary.value("wall_s", 0.0),
             speed_text(summary.value("real_time_factor", 0.0)), summary.value("firings", 0ULL),
             printable(summary.value("ended", "")));
  print_subsystems(summary.value("subsystems", json::array()));
  print_chains(summary.value("chains", json::array()));
  fmt::print("{}", overtime_text(summary, outcome.slow_calls));
  fmt::print("{}", printable(judgement_lines(summary.dump())));
  if (outcome.drive && !outcome.drive->is_whole)
    fmt::print(
        "Laps and losses of the line need the whole recording: add --record-limit none, or name laps(...) "
        "under `measures`.\n");
  if (measures_whole_drive(outcome)) {
    const sim::LineMetrics& line = outcome.drive->metrics;
    fmt::print("{:.2f} laps; line lost for {:.2f} s; lateral error {:.1f} mm mean, {:.1f} mm max\n",
               line.laps, line.line_lost_s, line.mean_error_m * 1000, line.max_error_m * 1000);
  }
  if (outcome.paths && !outcome.paths->has_poses)
    fmt::print("the recording has no poses of the world, so there is no path\n");
  if (outcome.floor && !outcome.robots.empty()) fmt::print("{}\n", several_robots(outcome.robots));
  fmt::print("recording: {}\n", outcome.recording.string());
}

std::vector<report::ChainTimes> chain_times_of(const RunOutcome& outcome, const spec::Model& model) {
  std::string error;
  const std::optional<Recording> recording = read_recording(outcome.recording.string(), error);
  if (!recording) throw std::runtime_error(error);
  std::vector<report::ChainTimes> chains;
  for (const replay::AgesOfChain& one : replay::ages_in({&*recording, 1}, model))
    chains.push_back({one.measured.group,
                      one.measured.chains,
                      {one.measured.age, one.age_ns},
                      {one.measured.reaction, one.reaction_ns},
                      one.why,
                      timeless_note(one)});
  return chains;
}

void write_report(RunOutcome outcome, const verify::Report& verification, const fs::path& folder) {
  check_report(folder.string());
  fs::create_directories(folder);
  for (const report::File& file : report::render(report_input(std::move(outcome), verification))) {
    write_output((folder / file.name).string(), file.bytes);
    terminal().say(fmt::format("report: {}\n", (folder / file.name).string()));
  }
}

}  // namespace tessera::cli
