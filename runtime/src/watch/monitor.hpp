#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "assembly/assembly.hpp"
#include "watch/monitor_client.hpp"
#include "watch/monitor_protocol.hpp"
#include "watch/monitor_socket.hpp"
#include "watch/remote_control.hpp"

namespace tessera {

/// Serves what the subsystems show, and the recording (tessera/monitor.hpp), in a thread of its own, from
/// construction to destruction, which is best after the recorder was closed: the last clients see all of it.
/// Takes no part in the run: what goes wrong with it is in `warn_of_failure` and ends nothing.
///
/// Threads: made and destroyed by one; the assembly must outlive it.
class Monitor {
 public:
  /// remote: takes commands; nullptr: there are none.
  Monitor(Assembly& assembly, const Clock& clock, RemoteControl* remote = nullptr);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  /// A warning on the console unless it listens.
  void warn_of_failure(Time now) const;

 private:
  void serve();
  void serve_until_ended();
  void accept_client();
  void receive(MonitorClient& client);
  void receive_rest(MonitorClient& client);
  void remove_gone_clients();
  void send_snapshots();
  void send_end(MonitorClient& client);
  [[nodiscard]] std::string snapshot_line() const;

  void execute_commands(MonitorClient& client);
  void execute_request(MonitorClient& client, const Request& request);
  // What is wrong with the command; empty: it is done.
  [[nodiscard]] static std::string execute(const commands::Malformed& command);
  [[nodiscard]] std::string execute(const SimulationCommand& command);
  [[nodiscard]] std::string execute(const commands::SetParameter& command);
  [[nodiscard]] std::string execute(const commands::EmergencyStop& command);
  [[nodiscard]] std::string execute(const commands::Reset& command);

  Assembly& assembly_;
  const Clock& clock_;
  std::string recording_path_, failure_;
  MonitorSocket listening_;
  int ending_ = -1;
  bool cannot_accept_ = false;  // no descriptor is left: it tries again after the next line
  RemoteControl* remote_;
  std::vector<std::unique_ptr<MonitorClient>> clients_;
  std::thread thread_;
};

}  // namespace tessera
