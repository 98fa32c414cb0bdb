#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tessera/controller.hpp"

namespace tessera {

/// What trying many schedules came to.
struct ScheduleReport {
  std::uint64_t first_seed = 1, asked = 0;
  std::uint64_t tried = 0;    ///< runs that were made to their end, with the one that failed
  Duration simulated{};       ///< of all of them
  std::uint64_t firings = 0;  ///< of all of them
  double wall_s = 0;
  int interrupted = 0;  ///< the signal that ended the search; 0: none
  struct Failure {
    std::uint64_t seed;
    RunSummary summary;
  };
  std::optional<Failure> failed;  ///< the first
};

/// Runs the system `count` times under the simulated clock, interleaved firing by firing, from options.seed
/// on, each with the next seed, until a run fails: a broken assertion, an error that no `next` routes,
/// nothing that can ever happen again, a world that fails. Nothing is recorded: the run of a seed is made
/// again by
/// `--interleave --seed`. Without a duration a run that does not end goes on for ever.
///
/// Errors: the controller cannot start: nullopt and `error`.
/// Threads: as execute. What user code keeps outside its subsystems lasts from run to run.
[[nodiscard]] std::optional<ScheduleReport> try_schedules(const System& system, RunOptions options,
                                                          std::uint64_t count, std::string& error);

/// A sentence for people, with its end of line.
[[nodiscard]] std::string schedules_line(const ScheduleReport& report);
/// {"asked", "tried", "first_seed", "simulated_s", "wall_s", "firings", "interrupted", "failure": null or
/// {"seed", "at_s", "ended"}}
[[nodiscard]] std::string schedules_json(const ScheduleReport& report);

}  // namespace tessera
