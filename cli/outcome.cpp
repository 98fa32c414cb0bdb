#include "cli/outcome.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "cli/outputs.hpp"
#include "cli/path_plot.hpp"
#include "cli/terminal.hpp"
#include "tessera/judgement.hpp"
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

report::DrivenPath drive_over(const Floor& floor, sim::Trace trace) {
  report::DrivenPath drive;
  drive.floor = value_or_throw(sim::Track::load(floor.image.string(), floor.metres_per_pixel));
  drive.trace = std::move(trace);
  drive.line = sim::skeleton(drive.floor);
  if (!drive.line.points.empty()) drive.metrics = sim::measure(drive.line, drive.trace);
  return drive;
}

report::ReportInput report_input(RunOutcome outcome, const verify::Report& verification) {
  std::string error;
  report::ReportInput input;
  std::optional<Recording> recording = read_recording(outcome.recording.string(), error);
  if (!recording) throw std::runtime_error(error);
  input.recording = std::move(*recording);
  input.drive = std::move(outcome.drive);
  if (outcome.has_track) input.robots = outcome.robots;
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

}  // namespace

RunOutcome read_outcome(const Controller& controller, const LaunchOptions& options) {
  const Specification& specification = controller.specification;
  const RunFiles files = run_files(options);
  RunOutcome outcome{read_summary(files.summary), files.recording, std::nullopt, {}, false};
  const std::optional<spec::Simulation>& simulation = specification.model.simulation;
  const bool has_world = simulation && !(simulation->world.empty() && options.world.empty());
  if (!has_world || !fs::exists(files.trace)) return outcome;
  sim::Trace trace = value_or_throw(sim::read_trace(files.trace.string()));
  outcome.robots = trace.robots;
  const std::optional<Floor> floor = floor_of(specification, options);
  outcome.has_track = floor.has_value();
  if (floor && outcome.robots.empty()) outcome.drive = drive_over(*floor, std::move(trace));
  return outcome;
}

std::string to_json(const RunOutcome& outcome) {
  json result = outcome.summary;
  if (outcome.drive && !outcome.drive->line.points.empty()) {
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

}  // namespace

void print(const RunOutcome& outcome) {
  const json& summary = outcome.summary;
  if (outcome.drive) fmt::print("{}", path_plot(outcome.drive->floor, outcome.drive->trace));
  fmt::print("{:.1f} s in {:.2f} s ({:.0f} x real time), {} firings, ended by: {}\n",
             summary.value("simulated_s", 0.0), summary.value("wall_s", 0.0),
             summary.value("real_time_factor", 0.0), summary.value("firings", 0ULL),
             summary.value("ended", ""));
  print_subsystems(summary.value("subsystems", json::array()));
  fmt::print("{}", judgement_lines(summary.dump()));
  if (outcome.drive && !outcome.drive->line.points.empty()) {
    const sim::LineMetrics& line = outcome.drive->metrics;
    fmt::print("{:.2f} laps; line lost for {:.2f} s; lateral error {:.1f} mm mean, {:.1f} mm max\n",
               line.laps, line.line_lost_s, line.mean_error_m * 1000, line.max_error_m * 1000);
  }
  if (outcome.has_track && !outcome.robots.empty())
    fmt::print("{}\n", report::several_robots(outcome.robots));
  fmt::print("recording: {}\n", outcome.recording.string());
}

void write_report(RunOutcome outcome, const verify::Report& verification, const fs::path& folder) {
  check_report(folder.string());
  fs::create_directories(folder);
  for (const report::File& file : report::render(report_input(std::move(outcome), verification))) {
    write_output((folder / file.name).string(), file.bytes);
    fmt::print(stderr, "report: {}\n", (folder / file.name).string());
  }
}

}  // namespace tessera::cli
