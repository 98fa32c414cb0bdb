#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "project/process/control_connection.hpp"
#include "project/process/control_reader.hpp"
#include "tessera/control_messages.hpp"

namespace tessera::cli {

/// The connection to the control socket of a running controller (tessera/monitor.hpp).
///
/// Threads: one.
class RunningController {
 public:
  /// nullopt: no process listens there, or it accepts no connection within a second.
  [[nodiscard]] static std::optional<RunningController> attach(const std::filesystem::path& socket_file);
  RunningController(project::ControlConnection connection, const std::filesystem::path& socket_file)
      : connection_(std::move(connection)), name_(socket_file.stem().string()) {}
  /// SYSTEM.PID, or SYSTEM.PROCESS.PID of a deployed system.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// If the name of the socket is shortened, takes the full name from the first message, which stays unread.
  /// Waits for that message for so long. false: none came, as from a process that hangs; it keeps the name of
  /// the socket.
  bool learn_name(std::chrono::milliseconds longest = std::chrono::seconds(2));

  /// The next message from the controller. nullopt: it has ended or was silent for too long
  /// (`be_patient_for`).
  [[nodiscard]] std::optional<project::ControlMessage> message();
  /// The same, but the message stays unread. nullptr: there is none.
  [[nodiscard]] const project::ControlMessage* coming_message();
  /// Limits all later waits to this time, because the process may be stopped or hang.
  void be_patient_for(std::chrono::milliseconds time) { connection_.limit_waits(time); }
  /// Sends a command. false: the controller has ended, or accepts no data for `patience`.
  bool tell(const ControlCommand& command);
  /// The answer to the last command. nullopt: the controller has ended, or does not answer until `end`. first: gets
  /// its first state, if that comes before the answer.
  [[nodiscard]] std::optional<CommandAnswer> answer(
      std::chrono::steady_clock::time_point end = std::chrono::steady_clock::now() + patience,
      std::optional<Snapshot>* first = nullptr);
  static constexpr std::chrono::seconds patience{2};

 private:
  project::ControlConnection connection_;
  std::string name_;
  project::ControlReader heard_;
  std::optional<project::ControlMessage> coming_;  ///< nullopt: it was not looked at yet
  std::int64_t told_ = 0;                          ///< number of the last command
};

/// A controller and its first message, which stays unread.
struct SeenController {
  RunningController controller;
  std::optional<Snapshot> snapshot;  ///< nullopt: none within two seconds
};
/// Sends no request, and listens to all of them at once.
[[nodiscard]] std::vector<SeenController> first_look(std::vector<RunningController> controllers);
/// The name of the deployed system whose processes they all are; nullopt: they are not.
[[nodiscard]] std::optional<std::string> common_deployment(const std::vector<SeenController>& controllers);
/// "tessera: error: several controllers are running (...): name one, ..."
int complain_of_several(const std::vector<SeenController>& controllers);

struct FoundControllers {
  std::vector<RunningController> running;
  /// Sockets of processes that hang or are stopped: they take no connection within a second, or do not say
  /// their names. They may be meant.
  std::vector<std::filesystem::path> silent;
  [[nodiscard]] bool none() const { return running.empty() && silent.empty(); }
};
using Greet = std::function<void(RunningController&)>;
/// All controllers that `which` names: a system, a process, or empty for all. Prints nothing. greet: gets each one
/// as soon as it is reached, so that one that hangs does not delay the others.
[[nodiscard]] FoundControllers look_for_controllers(const std::string& which, const Greet& greet = {});
/// The same, and prints an error if there is none.
[[nodiscard]] FoundControllers find_controllers(const std::string& which);
/// Names controllers of this user whose sockets are in a folder where this process does not look, as its environment
/// is another one, and says how to stop them. Returns `ok` if there is none.
int complain_of_other_folders(const std::string& which);
/// Names controllers of this user that run without a control socket. Returns `ok` if there is none.
int complain_of_unreachable();
/// Prints "tessera: error: no controller is running ...", or that it is unknown, because the folder of the sockets is
/// not this user's.
int complain_of_none(const std::string& which);
/// Prints for each: "tessera: error: NAME does not answer (socket ...): WHAT". Returns `ok` if there is none.
int complain_of_silent(const std::vector<std::filesystem::path>& silent, const std::string& what);

}  // namespace tessera::cli
