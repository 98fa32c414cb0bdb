#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "project/process/control_connection.hpp"
#include "project/process/control_messages.hpp"
#include "project/process/control_reader.hpp"

namespace tessera::cli {

/// The connection to the control socket of a running controller (tessera/monitor.hpp).
///
/// Threads: one.
class RunningController {
 public:
  /// nullopt: no process listens there, or it accepts no connection within a second.
  [[nodiscard]] static std::optional<RunningController> attach(const std::filesystem::path& socket_file);
  /// SYSTEM.PID, or SYSTEM.PROCESS.PID of a deployed system.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// If the name of the socket is shortened, takes the full name from the first message, which stays unread.
  /// Waits for that message for two seconds; a process that hangs keeps the name of the socket.
  void learn_name();

  /// The next message from the controller. nullopt: it has ended or was silent for too long
  /// (`be_patient_for`).
  [[nodiscard]] std::optional<project::ControlMessage> message();
  /// The same, but the message stays unread. nullptr: there is none.
  [[nodiscard]] const project::ControlMessage* coming_message();
  /// Limits all later waits to this time, because the process may be stopped or hang.
  void be_patient_for(std::chrono::milliseconds time) { connection_.limit_waits(time); }
  /// false: the controller has ended, or accepts no data.
  [[nodiscard]] bool send(std::string_view text) const { return connection_.send(text); }

 private:
  RunningController(project::ControlConnection connection, std::string name)
      : connection_(std::move(connection)), name_(std::move(name)) {}
  project::ControlConnection connection_;
  std::string name_;
  project::ControlReader heard_;
  std::optional<project::ControlMessage> coming_;  ///< nullopt: it was not looked at yet
};

/// A controller and its first message, which stays unread.
struct SeenController {
  RunningController controller;
  std::optional<project::Snapshot> snapshot;  ///< nullopt: none within two seconds
};
/// Sends no request, and listens to all of them at once.
[[nodiscard]] std::vector<SeenController> first_look(std::vector<RunningController> controllers);
/// The name of the deployed system whose processes they all are; nullopt: they are not.
[[nodiscard]] std::optional<std::string> common_deployment(const std::vector<SeenController>& controllers);
/// "tessera: error: several controllers are running (...): name one, ..."
int complain_of_several(const std::vector<SeenController>& controllers);

/// Prints "tessera: error: no controller is running ...".
int complain_of_none(const std::string& which);
/// All controllers that `which` names, as find_controllers. Prints nothing.
[[nodiscard]] std::vector<RunningController> running_controllers(const std::string& which);
/// All controllers that `which` names: a system, a process, or empty for all. Prints an error if there is
/// none.
[[nodiscard]] std::vector<RunningController> find_controllers(const std::string& which);

}  // namespace tessera::cli
