#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "project/launch.hpp"
#include "report/report.hpp"

namespace tessera::cli {

/// The result of a run: the controller's own summary and, on a track, how well the robot kept to the line.
struct RunOutcome {
  nlohmann::json summary;  ///< simulated_s, wall_s, real_time_factor, firings, ended, failed, subsystems
  std::filesystem::path recording;
  std::optional<report::DrivenPath> drive;
  std::string robots;  ///< "rover, rover_2": several move in the world, so there is no drive; empty: one
  std::optional<report::RunPaths> paths;      ///< of a simulated world
  std::optional<sim::Track> floor;            ///< that the world has
  std::vector<report::ChainTimes> chains;     ///< only for a report
  std::vector<report::SlowCalls> slow_calls;  ///< from `summary`
  nlohmann::json curves;                      ///< of checks and measures; to_json leaves them out
};

/// Reads the files of the run. Throws std::runtime_error if one of them cannot be read.
[[nodiscard]] RunOutcome read_outcome(const project::Controller& controller,
                                      const project::LaunchOptions& options);

/// {"simulated_s", "wall_s", "real_time_factor", "firings", "recording", "ended", "failed", "subsystems"}.
/// On a track also "laps", "line_lost_s", "longest_loss_s", "lateral_error_m": {"mean", "max"}; with
/// several robots in the world "robots" instead. If the recording has lost its beginning, it has "recorded_from_s"
/// and nothing that would need the whole.
[[nodiscard]] std::string to_json(const RunOutcome& outcome);

/// The same for people, on standard output.
void print(const RunOutcome& outcome);

/// How old the readings were that the commands of the run acted on, for its report.
[[nodiscard]] std::vector<report::ChainTimes> chain_times_of(const RunOutcome& outcome,
                                                             const spec::Model& model);

/// Writes index.html, poster.png and, with a drive, path.png to `folder`, which is made if it does not exist.
/// Standard error names the files. Throws std::runtime_error if one cannot be written.
void write_report(RunOutcome outcome, const verify::Report& verification,
                  const std::filesystem::path& folder);

}  // namespace tessera::cli
