#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tessera/controller.hpp"

namespace tessera {

/// The result of trying many schedules.
struct ScheduleReport {
  std::uint64_t first_seed = 1, asked = 0;
  std::uint64_t tried = 0;    ///< completed runs, including the one that failed
  Duration simulated{};       ///< sum over all runs
  std::uint64_t firings = 0;  ///< sum over all runs
  double wall_s = 0;
  int interrupted = 0;  ///< the signal that ended the search; 0: none
  struct Failure {
    std::uint64_t seed;
    RunSummary summary;
  };
  std::optional<Failure> failed;  ///< the first failure
};

/// Runs the system `count` times under the simulated clock, interleaved firing by firing. The first run has
/// options.seed, each later one the next seed. It stops at the first run that fails: a broken assertion,
/// an error that no `next` handles, a state in which nothing can ever happen again, or a world that fails.
/// Nothing is recorded; `--interleave --seed` repeats the run of a seed. Without a duration, a run that
/// does not end goes on for ever.
///
/// Errors: the controller cannot start: nullopt and `error`.
/// Threads: as execute. Data that user code keeps outside its subsystems lasts from run to run.
[[nodiscard]] std::optional<ScheduleReport> try_schedules(const System& system, RunOptions options,
                                                          std::uint64_t count, std::string& error);

/// One sentence for people, with a newline.
[[nodiscard]] std::string schedules_line(const ScheduleReport& report);
/// {"asked", "tried", "first_seed", "simulated_s", "wall_s", "firings", "interrupted", "failure": null or
/// {"seed", "at_s", "ended"}}
[[nodiscard]] std::string schedules_json(const ScheduleReport& report);

}  // namespace tessera
