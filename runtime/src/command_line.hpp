#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tessera/controller.hpp"

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

/// "60s", "1.5 min", "200ms", "2h", "90" (seconds). nullopt: none of these, or negative.
[[nodiscard]] std::optional<Duration> parse_duration(std::string text);

/// "500MB" (in four segments), "100MBx5" (so many of that size); B, kB, MB, GB. nullopt: none of these.
[[nodiscard]] std::optional<RunOptions::Limit> parse_record_limit(std::string text);

/// "robot.sensor.left=reflectance:eye_left,noise=0.01". nullopt and `error` otherwise.
[[nodiscard]] std::optional<DriverRequest> parse_driver(const std::string& text, std::string& error);

}  // namespace tessera
