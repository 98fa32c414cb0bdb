#pragma once

#include <string>
#include <vector>

#include "assembly/assembly.hpp"

namespace tessera {

/// The devices of real effectors that nothing makes safe if the controller is killed: no guardian serves them,
/// and their drivers have no heartbeat, which would mean that the device has a timeout of its own.
/// Precondition: all are open.
[[nodiscard]] std::vector<std::string> unprotected_devices(const Assembly& assembly);

/// "robot.motor.left, robot.motor.right, and 30 more": a line must fit a terminal and a pipe.
[[nodiscard]] std::string listed_devices(const std::vector<std::string>& names);

/// The file RunOptions::death_note while a run has real devices. If the process is killed, it remains, and
/// whoever started the process learns from it which devices nothing has made safe.
///
/// Threads: one.
class DeathNote {
 public:
  /// Writes two empty lines, which LastChance replaces, and then a line for each device.
  DeathNote(std::string file, const std::vector<std::string>& unprotected);
  DeathNote(const DeathNote&) = delete;
  DeathNote& operator=(const DeathNote&) = delete;
  /// The run is over: removes the file.
  ~DeathNote();

 private:
  std::string file_;
};

}  // namespace tessera
