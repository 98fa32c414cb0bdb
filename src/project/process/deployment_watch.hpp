#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "project/process/control_connection.hpp"
#include "project/process/control_messages.hpp"

namespace tessera::project {

/// A process of a deployed system, as it is seen through its control socket.
struct WatchedProcess {
  using Clock = std::chrono::steady_clock;
  enum class State : std::uint8_t {
    running,
    silent,  ///< it does not tell what it does any more: it is stopped, or hangs
    ended,   ///< it has said so
    gone     ///< the connection ended without that: it has died, or was killed
  };
  State state = State::running;
  std::optional<Clock::time_point> since;  ///< of `state`; nullopt: it was so when it was found
  Clock::time_point heard;                 ///< its last line; if it has said nothing, when it was found
  std::string socket;                      ///< the file's name
  bool is_local = false;                   ///< a process of this machine, and not the end of a tunnel
  /// The last one. It has the name of the process; if it has said nothing, only that and the process number.
  Snapshot snapshot;

  [[nodiscard]] const std::string& name() const { return *snapshot.name; }
  [[nodiscard]] bool is_there() const { return state == State::running || state == State::silent; }
};

/// "running", "silent", "ended", "gone"
[[nodiscard]] const char* name_of(WatchedProcess::State state);

/// All processes of a deployed system that run on this machine as this user. It finds them by their control
/// sockets, those that start later too. A process that has died or ended stays in the list until another start
/// of it takes its place. So does one that had died before, as far as its socket was left behind. Processes
/// never wait for it, and do not notice whether it is there.
///
/// Threads: one.
class DeploymentWatch {
 public:
  using Clock = WatchedProcess::Clock;
  /// A process that tells nothing for so long is silent. In a usual system lines come five times a second.
  static constexpr std::chrono::milliseconds longest_silence{2000};
  /// Each line that a process sends, as it came.
  using EachLine = std::function<void(std::string_view)>;

  /// folder: of the sockets, tessera::monitor_folder(). net_hash: others are passed over; empty: none is.
  DeploymentWatch(std::filesystem::path folder, std::string system, std::string net_hash = {});

  /// Takes what has come, and waits for it at most `longest`. Returns whether anything has changed.
  bool poll(std::chrono::milliseconds longest, const EachLine& each_line = {});

  /// In the order of their names, numbers in them by value: cart[2] before cart[10].
  [[nodiscard]] std::vector<const WatchedProcess*> processes() const;
  /// The running one of that name; nullptr: there is none.
  [[nodiscard]] const WatchedProcess* find(std::string_view name) const;
  /// Processes of the system with another net than the one that was asked for.
  [[nodiscard]] std::size_t of_another_net() const { return of_another_net_; }

 private:
  struct Connected {
    std::optional<ControlConnection> connection;
    Clock::time_point made;
    std::string text;  ///< received, up to an end of line that has not come
    std::optional<WatchedProcess> process;
    bool ignored = false;  ///< it is none of the deployment
  };
  void look_for_sockets();
  void note_found(const std::string& socket, Connected& one, WatchedProcess::State state) const;
  bool read(const std::string& socket, Connected& one, const EachLine& each_line);
  bool take(const std::string& socket, Connected& one, std::string_view line);
  void replace_older(const std::string& socket);
  bool notice_silence();

  std::filesystem::path folder_;
  std::string system_, net_hash_;
  std::map<std::string, Connected> connected_;  ///< by the name of the socket
  std::map<std::string, Clock::time_point> refused_;
  Clock::time_point next_look_{};
  std::size_t of_another_net_ = 0;
};

}  // namespace tessera::project
