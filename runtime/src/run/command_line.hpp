#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tessera/controller.hpp"
#include "tessera/given_values.hpp"

namespace tessera {

/// The requests on the command line of a controller.
struct CommandLine {
  RunOptions options;
  std::string summary;                     ///< file; "-": standard output; empty: none
  std::string from;                        ///< recording to run user code again from; empty: none
  std::string inputs;                      ///< recording whose real inputs replace the devices; empty: none
  std::optional<std::uint64_t> schedules;  ///< number of schedules to try; nullopt: one run
  unsigned jobs = 0;                       ///< of schedules: processes at a time; 0: one per core
  bool managed = false;                    ///< a managed node of ROS 2
  bool coverage = false;                   ///< of schedules: counts the firings of each transition
};

/// The command line, or the exit code with which to end (help: 0, wrong usage: 2, unreadable file:
/// 1). Prints help and errors.
[[nodiscard]] std::variant<CommandLine, int> parse_command_line(const System& system, int argc, char** argv);

}  // namespace tessera
