#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tessera/result.hpp"

namespace tessera {

/// The Unix socket at which a run listens (tessera/monitor.hpp), in a folder that only its owner may enter.
/// Making it removes the sockets of runs that were killed.
class MonitorSocket {
 public:
  /// The file is tessera::monitor_file(name, this process).
  explicit MonitorSocket(std::string_view name);
  ~MonitorSocket();
  MonitorSocket(const MonitorSocket&) = delete;
  MonitorSocket& operator=(const MonitorSocket&) = delete;

  /// -1: the socket does not listen; `failure` says why.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const std::optional<Problem>& failure() const { return failure_; }

  /// A connection of the owner of this process, or of root.
  struct Accepted {
    int socket = -1;         ///< -1: none
    bool exhausted = false;  ///< no descriptor is left: try again later
  };
  [[nodiscard]] Accepted accept() const;

 private:
  void listen(std::string_view name);

  std::string file_;
  std::optional<Problem> failure_;
  int descriptor_ = -1;
};

}  // namespace tessera
