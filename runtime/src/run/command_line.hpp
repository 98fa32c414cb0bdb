#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tessera/controller.hpp"
#include "tessera/given_values.hpp"

namespace tessera {

/// What the command line of a controller asks for.
struct CommandLine {
  RunOptions options;
  std::string summary;          ///< file; "-": standard output; empty: none
  std::string from;             ///< recording to run user code again from; empty: none
  std::uint64_t schedules = 0;  ///< how many to try; 0: one run
};

/// The command line, or the exit code with which to leave (help: 0, wrong usage: 2, unreadable file: 1).
/// Prints help and complaints.
[[nodiscard]] std::variant<CommandLine, int> parse_command_line(const System& system, int argc, char** argv);

/// "robot.sensor.left=reflectance:eye_left,noise=0.01". nullopt and `error` otherwise.
[[nodiscard]] std::optional<DriverRequest> parse_driver(const std::string& text, std::string& error);

}  // namespace tessera
