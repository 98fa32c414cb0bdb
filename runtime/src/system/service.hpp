#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdint>
#include <optional>
#include <string_view>

#include "tessera/time.hpp"

namespace tessera {

/// Tells the service manager (systemd, `Type=notify`) how the run goes: datagrams to the socket that the
/// environment variable NOTIFY_SOCKET names (sd_notify(3), without libsystemd). Without the variable it does
/// nothing. Nothing waits: what the manager does not take is lost.
///
/// Threads: one at a time.
class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID, and removes them, so that programs which user code
  /// starts do not speak for this one.
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  void ready() { send("READY=1"); }
  void stopping() { send("STOPPING=1"); }
  /// One line for `systemctl status`.
  void status(std::string_view text);
  /// Sends the watchdog's sign of life if it is time for one. Call it only while all is well. Returns when to
  /// call it next; Time::max(): the manager does not ask for it.
  [[nodiscard]] Time beat(Time now);

 private:
  void send(std::string_view message) const;
  int socket_ = -1;
  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  std::optional<Duration> period_;
  Time next_{};
};

/// Standard error is the journal (JOURNAL_STREAM): lines begin with their level, and nothing is rewritten.
[[nodiscard]] bool writes_to_journal();

}  // namespace tessera
