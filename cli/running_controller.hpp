#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "project/process/control_connection.hpp"

namespace tessera::cli {

/// The connection to the control socket of a running controller (tessera/monitor.hpp).
///
/// Threads: one.
class RunningController {
 public:
  /// nullopt: no process listens there, or it takes no connection within a second.
  [[nodiscard]] static std::optional<RunningController> attach(const std::filesystem::path& socket_file);
  /// SYSTEM.PROCESS
  [[nodiscard]] const std::string& name() const { return name_; }

  /// The next line from the controller. nullopt: it has ended or was silent for too long (`be_patient_for`).
  [[nodiscard]] std::optional<std::string> line();
  /// Limits all later waits to this time, because the process may be stopped or hang.
  void be_patient_for(std::chrono::milliseconds time) { connection_.limit_waits(time); }
  /// false: the controller has ended, or takes nothing.
  [[nodiscard]] bool send(std::string_view text) const { return connection_.send(text); }

 private:
  RunningController(project::ControlConnection connection, std::string name)
      : connection_(std::move(connection)), name_(std::move(name)) {}
  project::ControlConnection connection_;
  std::string name_, pending_;
};

/// All controllers that `which` means: a system, a process, or empty for all. If
/// there is none, prints that.
[[nodiscard]] std::vector<RunningController> find_controllers(const std::string& which);

/// The controller that `which` means: a system, a process, or empty for any. nullopt after the reason has
/// been printed, for example that there are several.
[[nodiscard]] std::optional<RunningController> find_controller(const std::string& which);

}  // namespace tessera::cli
