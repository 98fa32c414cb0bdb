#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "project/process/control_reader.hpp"

namespace tessera::project {

/// The client's end of the control socket of a running controller (tessera/monitor.hpp). The messages are
/// those of control_messages.hpp; a ControlReader finds them in what comes.
///
/// Threads: `send` and `is_process` any, one at a time; the rest one.
class ControlConnection {
 public:
  /// nullopt: no process listens there, or it takes no connection within a second.
  [[nodiscard]] static std::optional<ControlConnection> to(const std::filesystem::path& socket_file);
  struct Attempt;
  /// Does not wait.
  [[nodiscard]] static Attempt attempt(const std::filesystem::path& socket_file);
  ControlConnection(ControlConnection&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, std::nullopt)) {}
  ControlConnection& operator=(ControlConnection&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ControlConnection(const ControlConnection&) = delete;
  ControlConnection& operator=(const ControlConnection&) = delete;
  ~ControlConnection();

  /// Limits all later waits to this time, because the process may be stopped or hang. Without it, they
  /// have no limit.
  void limit_waits(std::chrono::milliseconds time) const;
  /// Sends all of it. false: the controller has ended, or takes nothing.
  [[nodiscard]] bool send(std::string_view text) const;
  /// Whether the other end is that process of this machine, and not the end of a tunnel.
  [[nodiscard]] bool is_process(std::int64_t id) const;

  enum class Received : std::uint8_t {
    bytes,
    nothing,  ///< yet, or within the limit
    over      ///< the other end has closed, or the connection is lost
  };
  /// Adds what has come. Waits for it with `receive`, but not with `receive_at_once`.
  [[nodiscard]] Received receive(ControlReader& to) const { return receive(to, 0); }
  [[nodiscard]] Received receive_at_once(ControlReader& to) const;
  /// Returns once something has come, or the time is over.
  void wait(std::chrono::milliseconds time) const { wait_for_any({this}, time); }
  /// The same for several.
  static void wait_for_any(const std::vector<const ControlConnection*>& connections,
                           std::chrono::milliseconds time);

 private:
  explicit ControlConnection(int descriptor) : descriptor_(descriptor) {}
  [[nodiscard]] Received receive(ControlReader& to, int flags) const;
  std::optional<int> descriptor_;
};

struct ControlConnection::Attempt {
  std::optional<ControlConnection> connection;
  /// There is no connection, but a process may listen all the same: one that is stopped or hangs, or whose queue
  /// is full at the moment. false: no process listens there.
  bool may_listen = false;
};

/// The control sockets in a folder, tessera::monitor_folder(), sorted by name. A process that was killed
/// leaves its own behind: nobody listens there. Empty, too, if that folder is not this user's alone
/// (tessera::wrong_with_monitor_folder).
[[nodiscard]] std::vector<std::filesystem::path> control_sockets(const std::filesystem::path& folder);

}  // namespace tessera::project
