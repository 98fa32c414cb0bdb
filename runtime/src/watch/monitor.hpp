#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "assembly/assembly.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/result.hpp"
#include "watch/monitor_client.hpp"
#include "watch/monitor_socket.hpp"
#include "watch/remote_control.hpp"
#include "watch/stop_answers.hpp"

namespace tessera {

/// Serves snapshots of the subsystems, and the recording, to clients (tessera/monitor.hpp). It runs in a
/// thread of its own, from construction to destruction. It is best destroyed after the recorder was closed:
/// the last clients then receive the whole recording. The run does not depend on it: `warn_of_failure`
/// reports its failures, which end nothing.
///
/// Threads: made and destroyed by one thread. The assembly must outlive it.
class Monitor {
 public:
  /// The socket by itself: clients can connect, and their commands wait until there is a monitor.
  [[nodiscard]] static std::unique_ptr<MonitorSocket> listen(const Assembly& assembly);
  /// Executes the commands that have come to the socket before it returns. remote: receives the commands; nullptr:
  /// commands are not accepted.
  Monitor(Assembly& assembly, const Clock& clock, std::unique_ptr<MonitorSocket> listening,
          RemoteControl* remote = nullptr);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  /// Why it does not listen; nullopt: it does.
  [[nodiscard]] const std::optional<Problem>& failure() const { return failure_; }
  /// Prints a warning on the console if the monitor does not listen.
  void warn_of_failure(Time now) const;

 private:
  void serve();
  void serve_until_ended();
  bool accept_client();
  [[nodiscard]] bool make_room();
  void put_on_trial(MonitorClient& client) const;
  void receive(MonitorClient& client);
  void receive_rest(MonitorClient& client);
  void remove_gone_clients();
  void send_snapshots();
  void send_end(MonitorClient& client);
  [[nodiscard]] Snapshot snapshot() const;

  void execute_commands(MonitorClient& client);
  void execute_request(MonitorClient& client, const ControlRequest& request);
  template <class Command>
  void send_piece(MonitorClient& client, const Command& command);
  void answer_stops();
  static void answer(MonitorClient& client, const CommandAnswer& answer);
  // Returns the mistake in the command; nullopt: it was executed.
  [[nodiscard]] std::optional<Problem> execute(const SimulationCommand& command);
  [[nodiscard]] std::optional<Problem> execute(const command::Set& command);
  [[nodiscard]] std::optional<Problem> execute(const command::Panel& command);
  [[nodiscard]] Offered offered() const;
  [[nodiscard]] bool is_elsewhere(const ControlCommand& command) const;
  [[nodiscard]] std::optional<Problem> execute(const command::EmergencyStop& command);
  [[nodiscard]] std::optional<Problem> execute(const command::Reset& command);

  Assembly& assembly_;
  const Clock& clock_;
  std::string recording_path_;
  std::optional<Problem> failure_;
  std::unique_ptr<MonitorSocket> listening_;
  int ending_ = -1;
  bool cannot_accept_ = false;  // no descriptor is left: try again after the next line
  RemoteControl* remote_;
  std::vector<std::unique_ptr<MonitorClient>> clients_;
  StopAnswers stops_;
  std::thread thread_;
};

}  // namespace tessera
