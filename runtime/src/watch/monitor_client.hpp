#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/growing_recording.hpp"

namespace tessera {

/// The connection of a monitor to one client, with what has been received and what has not been sent yet.
/// Never waits for the client.
///
/// Threads: the monitor's.
class MonitorClient {
 public:
  /// Owns the socket from now on.
  explicit MonitorClient(int socket) : socket_(socket) {}
  ~MonitorClient();
  MonitorClient(const MonitorClient&) = delete;
  MonitorClient& operator=(const MonitorClient&) = delete;

  /// At most so many bytes of commands are received from a client that has gone.
  static constexpr std::size_t longest_command = std::size_t{1} << 20U;

  [[nodiscard]] int socket() const { return socket_; }
  /// The connection is lost, or the client has broken its limits.
  [[nodiscard]] bool gone() const { return gone_; }
  /// The client has taken everything.
  [[nodiscard]] bool up_to_date() const { return unsent_.empty(); }
  /// The run ends with this connection.
  [[nodiscard]] bool owns_run() const { return owns_run_; }
  void own_run() { owns_run_ = true; }

  /// Receives some of what has come; returns the number of bytes.
  std::size_t receive();
  /// The next line that has been received whole.
  [[nodiscard]] std::optional<std::string> take_line();
  /// A client with too much that is not taken, or not a whole line, is gone.
  void check_limits();

  /// Puts text behind what has not been sent yet.
  void add(std::string_view text);
  /// It has asked for the recording.
  [[nodiscard]] bool has_recording() const { return recording_ != nullptr; }
  /// Puts the next piece of the recording there. false: there was nothing new.
  bool add_piece(const std::string& recording);
  /// Sends as much as there is room for.
  void send();
  /// The client is not up to date, so it goes without this snapshot. It is gone if it has taken nothing for
  /// long.
  void skip_snapshot();
  /// Whether it has gone without a snapshot since that was asked last.
  [[nodiscard]] bool take_skipped();

 private:
  int socket_;
  std::string received_;                         // the beginning of a command
  std::string unsent_;                           // what its socket had no room for
  std::int64_t took_ns_ = 0;                     // when it last took some of that
  std::unique_ptr<GrowingRecording> recording_;  // nullptr: it has not asked for it
  bool skipped_ = false;                         // a snapshot
  bool owns_run_ = false;
  bool gone_ = false;
};

}  // namespace tessera
