#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "run/schedule_report.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// The schedules to try, and the way to try them.
struct ScheduleRequest {
  std::uint64_t count = 0;
  unsigned jobs = 0;      ///< processes at a time; 0: one per core that this process may use
  bool coverage = false;  ///< counts the firings of each transition
};

/// Runs the system `count` times under the simulated clock, interleaved firing by firing. The first run has
/// options.seed, each later one the next seed. A run fails by a broken assertion, an error that no `next`
/// handles, a state in which nothing can ever happen again, a subsystem that is stuck for good, a world that
/// fails, or the death of the process. Nothing is recorded; `--interleave --seed` repeats the run of a seed.
/// Without a duration, a run that does not end goes on for ever. A signal ends it with the results so far.
///
/// Errors: the controller cannot start: nullopt and `error`.
/// Threads: none may run, because it forks a process per job. Data that user code keeps outside its
/// subsystems stays from run to run in one process.
[[nodiscard]] std::optional<ScheduleReport> try_schedules(const System& system, RunOptions options,
                                                          const ScheduleRequest& request, std::string& error);

}  // namespace tessera
