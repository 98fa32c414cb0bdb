#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/growing_recording.hpp"

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
  [[nodiscard]] bool is_process(std::int64_t id);
  /// The last snapshot that has arrived. nullopt: none since the last call. Does not wait.
  [[nodiscard]] std::optional<nlohmann::json> snapshot();
  /// The bytes of the controller's recording after those that were requested before, as of
  /// the last `snapshot`. Waits a tenth of a second for them. A piece without bytes, but with
  /// `more`: they are on the way.
  [[nodiscard]] GrowingRecording::Piece recording();
  /// Returns what is wrong with the command; empty: it is done. Waits for the connection and for the
  /// answer, at most five seconds each. In the meantime, another thread has to call connect and snapshot.
  [[nodiscard]] std::string command(nlohmann::json command);
  /// Whether the other end has closed the connection, or `close` was called.
  [[nodiscard]] bool is_over();
  /// Whether the controller has said that its run is over. If not, and is_over, the connection was lost.
  [[nodiscard]] bool has_ended() const { return ended_; }
  /// Ends the connection: there will be no more answers.
  void close();

 private:
  [[nodiscard]] bool say(const std::string& line);
  void hear();
  void understand();
  void take(nlohmann::json line);
  int socket_ = -1;
  std::string heard_;
  std::optional<nlohmann::json> snapshot_;
  bool asked_ = false, ended_ = false;
  std::optional<GrowingRecording::Piece> piece_;  ///< messages behind it wait until it is taken
  /// guards the members below, and writing to and closing the socket
  std::mutex mutex_;
  std::condition_variable answered_;
  std::map<int, std::string> answers_;
  int last_ = 0;
  bool open_ = false, over_ = false;
};

/// Names in tessera::monitor_folder() of sockets where a process listens: controllers on this machine,
/// and ends of tunnels to others.
[[nodiscard]] std::vector<std::string> listening_sockets();

}  // namespace tessera::server
