#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdint>
#include <optional>
#include <string_view>

#include "tessera/time.hpp"

namespace tessera {

/// Reports the state of the run to the service manager (systemd, `Type=notify`): datagrams to the socket
/// that the environment variable NOTIFY_SOCKET names (sd_notify(3), without libsystemd). Without the
/// variable it does nothing. It never waits: a datagram that the manager does not take is lost.
///
/// Threads: one at a time.
class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID, and removes them, so that programs started by
  /// user code cannot report for this process.
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  void ready() { send("READY=1"); }
  void stopping() { send("STOPPING=1"); }
  /// text: one line for `systemctl status`.
  void status(std::string_view text);
  /// Sends the sign of life for the watchdog if one is due. Call it only while the run is healthy. Returns
  /// when to call it next; Time::max(): the manager does not ask for it.
  [[nodiscard]] Time beat(Time now);

 private:
  void send(std::string_view message) const;
  int socket_ = -1;
  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  std::optional<Duration> period_;
  Time next_{};
};

/// Whether standard error is the journal (JOURNAL_STREAM): lines begin with their level, none is rewritten.
[[nodiscard]] bool writes_to_journal();

}  // namespace tessera
