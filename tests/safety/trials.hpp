#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include "robot_process.hpp"

namespace tessera::safety_test {

using std::chrono::milliseconds;

/// An event for a controller that drives a robot, and the commands that must be the last ones then.
struct Case {
  std::string name;
  /// Makes it happen. Returns when (CLOCK_MONOTONIC), or 0: the robot causes it itself, and the log has the
  /// time.
  std::function<std::int64_t(RobotProcess&)> strike;
  /// ends: by itself. goes_on: it drives on until SIGTERM, whose effect is measured. hangs: the devices are
  /// safe, and the test kills the rest. halts: it is stopped, and ends when it is continued. pauses: it is
  /// stopped, and drives on when it is continued, until SIGTERM.
  enum class After : std::uint8_t { ends, goes_on, hangs, halts, pauses } after = After::ends;
  RobotProcess::Output output = RobotProcess::Output::terminal;
  milliseconds bar{100};                 ///< declared time from the event to the last safe command
  std::string says{};                    ///< what must stand on the terminal then
  std::vector<std::string> arguments{};  ///< of the controller
  std::vector<std::string> command{};    ///< in place of the controller
  std::vector<std::string> environment{};
  int code = -1;   ///< the exit code of the process then; -1: any
  int hangs = -1;  ///< the device whose driver hangs, which no program can make safe; -1: none
};

/// Strikes so often as TESSERA_SAFETY_RUNS says (2), at random moments, several controllers at a time. Prints
/// a line of figures per case, to the file TESSERA_SAFETY_TABLE too. A trial fails when the last command of a
/// device is not the safe one; with TESSERA_SAFETY_STRICT also when it is late.
void try_all(const std::vector<Case>& cases);

[[nodiscard]] std::function<std::int64_t(RobotProcess&)> sends(int signal);
[[nodiscard]] std::function<std::int64_t(RobotProcess&)> types(char key);
[[nodiscard]] std::function<std::int64_t(RobotProcess&)> does(Harm harm, Place place);

}  // namespace tessera::safety_test
