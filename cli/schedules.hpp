#pragma once

#include <cstdint>
#include <string>

#include "project/build/controller.hpp"
#include "project/launch.hpp"

namespace tessera::cli {

/// Many runs of one controller.
struct ScheduleOptions {
  std::uint64_t count = 0;  ///< of all parts
  std::string part;         ///< "3/20"; empty: all of it
  unsigned jobs = 0;        ///< processes at a time; 0: one per core
  std::string results;      ///< file; empty: none
  std::string json;         ///< file, "-": standard output; empty: none
  std::string coverage;     ///< empty: none; shown_only; or a file
  std::string again;        ///< command that repeats one of the runs, when a seed is appended
};

/// Whether the part can be read; prints the mistake.
[[nodiscard]] bool is_part(const std::string& part);

/// Runs the schedules, and writes and prints the failures, their numbers, and their probabilities. command:
/// the controller's, of one run. Returns the exit code: 0 none failed, 1 some did, 128 + signal: interrupted.
int run_schedules(const project::Controller& controller, const project::LaunchOptions& options,
                  const ScheduleOptions& schedules, project::Command command);

}  // namespace tessera::cli
