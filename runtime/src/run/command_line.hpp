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
  std::string summary;          ///< file; "-": standard output; empty: none
  std::string from;             ///< recording to run user code again from; empty: none
  std::uint64_t schedules = 0;  ///< number of schedules to try; 0: one run
};

/// The command line, or the exit code with which to end (help: 0, wrong usage: 2, unreadable file:
/// 1). Prints help and errors.
[[nodiscard]] std::variant<CommandLine, int> parse_command_line(const System& system, int argc, char** argv);

}  // namespace tessera
