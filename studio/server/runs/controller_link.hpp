#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "project/process/control_connection.hpp"
#include "project/process/control_reader.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/growing_recording.hpp"
#include "tessera/result.hpp"

namespace tessera::server {

/// The control socket of a running controller (tessera/monitor.hpp).
///
/// Threads: `command` any; the rest one.
class ControllerLink {
 public:
  ControllerLink() = default;
  ~ControllerLink();
  ControllerLink(const ControllerLink&) = delete;
  ControllerLink& operator=(const ControllerLink&) = delete;

  /// Connects to the socket if a process listens there. own: the run ends with this connection.
  /// Returns whether it is connected.
  bool connect(const std::filesystem::path& socket, bool own);
  /// Whether the other end is that process of this machine, and not the end of a tunnel.
  [[nodiscard]] bool is_process(std::int64_t id) const;
  /// The newest snapshot; nullopt: none since the last call. Does not wait.
  [[nodiscard]] std::optional<Snapshot> snapshot();
  /// The part of the controller's recording since the last call, as of the last `snapshot`. Waits for it a
  /// tenth of a second; without bytes, but with `more`: it is on its way.
  [[nodiscard]] GrowingRecording::Piece recording();
  /// Requests the scene of the controller's world, piece by piece: call it again and again. Returns the whole
  /// scene once it has arrived; empty: there is none. Does not wait.
  [[nodiscard]] std::optional<std::string> scene();
  /// nullopt: done. Waits for the connection, at most a minute, and five seconds for the answer. Meanwhile
  /// another thread has to call connect and snapshot.
  [[nodiscard]] std::optional<Problem> command(const ControlCommand& command);
  /// Whether it is connected.
  [[nodiscard]] bool is_open();
  /// Whether the other end has closed the connection, or `close` was called.
  [[nodiscard]] bool is_over();
  /// Whether the controller has said that its run is over. If not, and is_over, the connection was lost.
  [[nodiscard]] bool has_ended() const { return ended_; }
  /// Ends the connection: there will be no more answers.
  void close();

 private:
  [[nodiscard]] bool say(const std::string& line) const;
  void hear();
  void understand();
  void take(CommandAnswer answer);
  void take(const SceneHead& head, std::string_view bytes);
  std::optional<project::ControlConnection> connection_;
  project::ControlReader heard_;
  std::optional<Snapshot> snapshot_;
  bool asked_ = false, ended_ = false;
  std::optional<GrowingRecording::Piece> piece_;  ///< later messages wait until it is taken
  std::string scene_;
  bool scene_asked_ = false, scene_complete_ = false;
  /// guards the members below, and writing to and closing the connection
  std::mutex mutex_;
  std::condition_variable answered_;
  std::map<std::int64_t, std::optional<Problem>> answers_;
  std::int64_t last_ = 0;
  bool open_ = false, over_ = false;
};

/// Names in tessera::monitor_folder() of sockets where a process listens: controllers on this machine, and
/// ends of tunnels to others.
[[nodiscard]] std::vector<std::string> listening_sockets();

}  // namespace tessera::server
