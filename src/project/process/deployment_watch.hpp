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
#include "project/process/control_reader.hpp"
#include "project/process/network_processes.hpp"
#include "project/process/watched_process.hpp"
#include "tessera/control_messages.hpp"

namespace tessera::project {

/// All processes of a deployed system. It finds those that run on this machine as this user by their control sockets,
/// and the others by the state that they send over the network, including those that start later. A process
/// that has died or ended stays in the list until another start of it takes its place. So does one that had
/// died before, if its socket was left behind. A control socket goes before the network. Processes never wait
/// for it.
///
/// Threads: one.
class DeploymentWatch {
 public:
  using Clock = WatchedProcess::Clock;
  static constexpr std::chrono::milliseconds longest_silence = project::longest_silence;
  /// Each line that a process sends, as it came.
  using EachLine = std::function<void(std::string_view)>;

  /// folder: of the sockets, tessera::monitor_folder(). net_hash: others are passed over; empty: none is.
  DeploymentWatch(std::filesystem::path folder, std::string system, std::string net_hash = {});

  /// Watches other machines, too. given: where the processes meet, as the specification says; nullopt: not known. A
  /// process of this machine knows better, unless `given` is `firm`. If all meet on loopback, and one of them is here,
  /// all are here: the network is not entered then.
  void watch_network(OpenFeed open, std::optional<Snapshot::Deployment> given = {}, bool firm = false);
  [[nodiscard]] bool watches_network() const { return feed_ != nullptr; }
  /// Remarks for a person about the watching of other machines; empty: none.
  [[nodiscard]] std::string remark() const { return feed_ == nullptr ? std::string() : feed_->remark(); }
  /// All processes that the deployment has, in its order; empty: not known.
  [[nodiscard]] const std::vector<Snapshot::Deployment::Process>& declared() const { return declared_; }

  /// Takes what has come, and waits for it at most `longest`. Returns whether anything has changed.
  bool poll(std::chrono::milliseconds longest, const EachLine& each_line = {});

  /// In the order of their names, numbers in them by value: cart[2] before cart[10].
  [[nodiscard]] std::vector<const WatchedProcess*> processes() const;
  /// The running one of that name; nullptr: there is none.
  [[nodiscard]] const WatchedProcess* find(std::string_view name) const;
  /// Processes of the system with another net than the one that was asked for.
  [[nodiscard]] std::size_t of_another_net() const { return of_another_net_ + elsewhere_.of_another_net(); }

 private:
  struct Connected {
    std::optional<ControlConnection> connection;
    bool takes_none = false;  ///< a process may listen, but takes no connection: another is tried
    Clock::time_point made;
    ControlReader heard;
    std::optional<WatchedProcess> process;
    bool ignored = false;  ///< it is none of the deployment
  };
  void look_for_sockets();
  void try_socket(const std::filesystem::path& file, const std::string& name);
  void note_found(const std::string& socket, Connected& one, WatchedProcess::State state) const;
  bool read(const std::string& socket, Connected& one, const EachLine& each_line);
  bool take(const std::string& socket, Connected& one, std::optional<ControlLine> line);
  void replace_older(const std::string& socket);
  bool notice_silence();
  void learn(const Snapshot::Deployment& deployment, bool is_local);
  void enter_network();
  [[nodiscard]] const WatchedProcess* find_here(std::string_view name) const;

  std::filesystem::path folder_;
  std::string system_, net_hash_;
  std::map<std::string, Connected> connected_;  ///< by the name of the socket
  std::map<std::string, Clock::time_point> refused_;
  Clock::time_point next_look_{};
  std::size_t of_another_net_ = 0;

  OpenFeed open_feed_;
  std::optional<Snapshot::Deployment> given_;  ///< not entered yet
  bool is_placed_ = false;                     ///< where the processes meet is known for good
  Clock::time_point patience_{};               ///< until then a process of this machine may say where
  std::unique_ptr<StatusFeed> feed_;
  NetworkProcesses elsewhere_;
  std::vector<Snapshot::Deployment::Process> declared_;
};

/// Whether only processes of this machine meet there.
[[nodiscard]] bool is_loopback(std::string_view interface);

}  // namespace tessera::project
