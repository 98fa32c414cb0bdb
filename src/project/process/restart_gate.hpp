#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "project/process/deployment_watch.hpp"

namespace tessera::project {

/// Whether a process of a deployment that has failed may begin again: not while an emergency stop stands.
///
/// A process that begins again has forgotten the stop, and would move its devices without a reset. So it
/// waits until no process of the system on this machine stands in an emergency stop. A stop that ends with
/// its process is no reset: if no process is left that was reset, the failed one stays down.
///
/// Threads: one. It watches the processes in a thread of its own, because a process that is stopped may
/// delay a connection.
class RestartGate {
 public:
  /// folder, net_hash: as of DeploymentWatch.
  RestartGate(const std::filesystem::path& folder, const std::string& system, const std::string& net_hash);
  ~RestartGate();
  RestartGate(const RestartGate&) = delete;
  RestartGate& operator=(const RestartGate&) = delete;

  enum class Answer : std::uint8_t { open, wait, closed };
  struct Verdict {
    Answer answer = Answer::open;
    std::string why;  ///< for a person; empty: there is nothing to say (yet)
  };
  /// The process has failed, and may be started again later.
  void failed(const std::string& process);
  /// The process is due. It opens only after every other process has reported its state since the first call.
  [[nodiscard]] Verdict ask(const std::string& process);

 private:
  using Clock = WatchedProcess::Clock;
  struct Seen {
    std::string name;
    WatchedProcess::State state;
    Clock::time_point heard;
    std::optional<std::string> emergency;
    [[nodiscard]] bool runs() const {
      return state == WatchedProcess::State::running || state == WatchedProcess::State::silent;
    }
    [[nodiscard]] bool stands() const { return runs() && emergency.has_value(); }
  };
  /// Knowledge about a process that has failed.
  struct Held {
    std::optional<Clock::time_point> asked;  ///< first
    std::set<std::string> stood;             ///< others that had an emergency stop since then
  };
  void watch_on(DeploymentWatch watch);
  void note_stops(const std::string& process, Held& held) const;
  [[nodiscard]] bool is_fresh(const std::string& process, Clock::time_point since) const;
  [[nodiscard]] std::string standing_besides(const std::string& process) const;
  [[nodiscard]] Verdict decide(const std::string& process, const Held& held) const;

  std::string system_;
  mutable std::mutex mutex_;
  std::vector<Seen> seen_;  ///< guarded by mutex_
  std::map<std::string, Held> held_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace tessera::project
