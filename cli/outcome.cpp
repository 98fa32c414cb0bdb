#include "cli/outcome.hpp"

#include <fmt/core.h>

#include <fstream>
#include <stdexcept>

#include "cli/path_plot.hpp"

namespace tessera::cli {

namespace {

using nlohmann::json;

json read_summary(const std::filesystem::path& file) {
  std::ifstream stream(file);
  json summary = json::parse(stream, nullptr, false);
  if (summary.is_discarded()) throw std::runtime_error("the controller left no readable summary in " + file.string());
  return summary;
}

void follow_line(RunOutcome& outcome, const std::filesystem::path& trace_file) {
  std::string error;
  outcome.trace = sim::read_trace(trace_file.string(), error);
  if (!outcome.trace) throw std::runtime_error(error);
  const std::optional<sim::Track> track =
      sim::Track::load(outcome.floor->image.string(), outcome.floor->metres_per_pixel, error);
  if (!track) throw std::runtime_error(error);
  const sim::Skeleton line = sim::skeleton(*track);
  if (!line.points.empty()) outcome.line = sim::measure(line, *outcome.trace);
}

}  // namespace

RunOutcome read_outcome(const Controller& controller, const LaunchOptions& options) {
  const RunFiles files = run_files(controller.specification, options);
  RunOutcome outcome;
  outcome.summary = read_summary(files.summary);
  outcome.recording = files.recording;
  const double wall = outcome.summary.value("wall_s", 0.0);
  outcome.summary["real_time_factor"] = wall > 0 ? outcome.summary.value("simulated_s", 0.0) / wall : 0.0;
  if (controller.specification.model.simulation) outcome.floor = floor_of(controller.specification, options);
  if (outcome.floor && std::filesystem::exists(files.trace)) follow_line(outcome, files.trace);
  return outcome;
}

std::string to_json(const RunOutcome& outcome) {
  json result = outcome.summary;
  result["recording"] = outcome.recording.string();
  if (outcome.line) {
    result["laps"] = outcome.line->laps;
    result["line_lost_s"] = outcome.line->line_lost_s;
    result["longest_loss_s"] = outcome.line->longest_loss_s;
    result["lateral_error_m"] = {{"mean", outcome.line->mean_error_m}, {"max", outcome.line->max_error_m}};
  }
  return result.dump(2) + "\n";
}

void print(const RunOutcome& outcome) {
  const json& summary = outcome.summary;
  if (outcome.line) fmt::print("{}", path_plot(*outcome.floor, *outcome.trace));
  fmt::print("{:.1f} s in {:.2f} s ({:.0f} x real time), {} firings, ended by: {}\n", summary.value("simulated_s", 0.0),
             summary.value("wall_s", 0.0), summary.value("real_time_factor", 0.0), summary.value("firings", 0ULL),
             summary.value("ended", ""));
  for (const json& subsystem : summary.value("subsystems", json::array()))
    fmt::print("  {:<24} {:>8} iterations  {:>4} overruns  {:>4} errors\n", subsystem.value("path", ""),
               subsystem.value("iterations", 0ULL), subsystem.value("overruns", 0ULL), subsystem.value("errors", 0ULL));
  if (outcome.line)
    fmt::print("{:.2f} laps; line lost {:.2f} s; lateral error {:.1f} mm mean, {:.1f} mm max\n", outcome.line->laps,
               outcome.line->line_lost_s, outcome.line->mean_error_m * 1000, outcome.line->max_error_m * 1000);
  fmt::print("recording: {}\n", outcome.recording.string());
}

}  // namespace tessera::cli
