#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "project/process/network_status.hpp"
#include "project/process/watched_process.hpp"

namespace tessera::project {

/// The latest start of each process of a deployed system, as it is heard over the network. One that is not
/// heard for `longest_silence` is silent: it has died, or the way to it is cut, which look the same from
/// here. It is gone when the middleware has forgotten it, 20 s after it was heard last.
///
/// Threads: one.
class NetworkProcesses {
 public:
  using Clock = WatchedProcess::Clock;
  /// net_hash: others are passed over; empty: none is.
  explicit NetworkProcesses(std::string net_hash) : net_hash_(std::move(net_hash)) {}

  /// each_line: gets the state of a process, as a line of JSON, and its name. Returns whether anything has changed.
  bool take(StatusFeed& feed,
            const std::function<void(const WatchedProcess& process, std::string_view line)>& each_line);
  /// Whether a process has become silent.
  bool notice_silence();
  [[nodiscard]] const std::map<std::string, WatchedProcess, std::less<>>& all() const { return all_; }
  [[nodiscard]] const WatchedProcess* find(std::string_view name) const;
  [[nodiscard]] std::size_t of_another_net() const { return of_another_net_; }

 private:
  const WatchedProcess* take(HeardStatus heard);
  std::string net_hash_;
  std::map<std::string, WatchedProcess, std::less<>> all_;  ///< by name
  std::size_t of_another_net_ = 0;
};

/// Chooses between two views of a process of one name, each of which may be nullptr. A control socket goes before the
/// network. A start elsewhere is shown if the one here is over and was earlier.
[[nodiscard]] const WatchedProcess* shown_of(const WatchedProcess* here, const WatchedProcess* elsewhere);

}  // namespace tessera::project
