#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/growing_recording.hpp"

namespace tessera {

/// The connection of a monitor to one client, with the received text and the text that is not sent yet. It
/// never waits for the client.
///
/// Threads: that of the monitor.
class MonitorClient {
 public:
  /// Owns the socket from now on.
  explicit MonitorClient(int socket) : socket_(socket) {}
  ~MonitorClient();
  MonitorClient(const MonitorClient&) = delete;
  MonitorClient& operator=(const MonitorClient&) = delete;

  /// The most bytes of commands that are received from a client that has gone.
  static constexpr std::size_t longest_command = std::size_t{1} << 20U;

  [[nodiscard]] int socket() const { return socket_; }
  /// Whether the connection is lost, or the client has exceeded its limits.
  [[nodiscard]] bool gone() const { return gone_; }
  /// Whether the client has received everything.
  [[nodiscard]] bool up_to_date() const { return unsent_.empty(); }
  /// Whether the run ends with this connection.
  [[nodiscard]] bool owns_run() const { return owns_run_; }
  void own_run() { owns_run_ = true; }

  /// Whether it has sent a command. Else it only watches.
  [[nodiscard]] bool has_asked() const { return has_asked_; }
  /// It must send a command until then, because enough others watch already.
  void expect_command_until(std::int64_t ns) { command_until_ns_ = ns; }
  [[nodiscard]] bool is_on_trial() const { return command_until_ns_ != 0 && !has_asked_; }
  [[nodiscard]] std::int64_t command_until_ns() const { return command_until_ns_; }

  /// Receives some of the bytes that have arrived, and returns their number.
  std::size_t receive();
  /// Removes and returns the next complete line; nullopt: there is none.
  [[nodiscard]] std::optional<std::string> take_line();
  /// Marks the client as gone if too much is not sent yet, or an incomplete line is too long.
  void check_limits();

  /// Appends to the text that is not sent yet.
  void add(std::string_view text);
  /// Whether the client has asked for the recording.
  [[nodiscard]] bool has_recording() const { return recording_ != nullptr; }
  /// Appends the next piece of the recording. false: there is nothing new.
  void add_scene(const std::string& file, std::uint64_t from);
  bool add_piece(const std::string& recording);
  /// Sends as much as the socket takes.
  void send();
  /// Leaves out a snapshot, because the client is not up to date. The client is gone if it has received
  /// nothing for a long time.
  void skip_snapshot();
  /// Whether a snapshot was left out since the last call.
  [[nodiscard]] bool take_skipped();

 private:
  int socket_;
  std::string received_;                         // the beginning of a command
  std::string unsent_;                           // text that the socket did not take yet
  std::int64_t took_ns_ = 0;                     // when the client last took some of it
  std::unique_ptr<GrowingRecording> recording_;  // nullptr: the client has not asked for it
  bool skipped_ = false;                         // a snapshot was left out
  std::int64_t command_until_ns_ = 0;            // 0: it need not send one
  bool has_asked_ = false;
  bool owns_run_ = false;
  bool gone_ = false;
};

}  // namespace tessera
