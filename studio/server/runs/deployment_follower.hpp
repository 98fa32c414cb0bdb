#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "project/process/deployment_watch.hpp"
#include "server/analysis/analysis.hpp"
#include "server/recordings/run_follower.hpp"

namespace tessera::server {

/// Collects the state of all processes of a deployed system: the snapshots of their control sockets, the
/// firings and values of their recordings, and the state that those of other machines send over the network.
/// The results are ready to be sent. The processes are not affected.
///
/// Times are those of the process that was found first; those of the others are shifted by the difference of
/// their clocks, measured when they were found. So they agree within some milliseconds.
///
/// Threads: one.
class DeploymentFollower {
 public:
  /// analysis: of a specification with `deploy:`; it and `reached` must outlive this object.
  /// open_feed: of the network; empty: only this machine is watched.
  DeploymentFollower(const Analysis& analysis, Reached& reached, project::OpenFeed open_feed = {});

  struct News {
    nlohmann::json firings, values, subsystems, deployment;  ///< data of the events; null: nothing new
    std::optional<std::vector<std::uint32_t>> marking;
    std::int64_t time_ns = 0;
    std::uint64_t total_firings = 0;
  };
  /// Waits some milliseconds for new data.
  [[nodiscard]] News poll();
  /// Whether some process runs, or did a moment ago: a process that has failed may be started again.
  [[nodiscard]] bool is_going_on() const;
  /// Why there is no data. Only while no process was found.
  [[nodiscard]] std::string why_nothing() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// One start of a process.
  struct Followed {
    std::unique_ptr<RunFollower> recording;  ///< nullptr: it cannot be read here
    std::vector<std::uint32_t> marked;       ///< the effect of this process's firings
    std::uint64_t firings = 0;
    std::int64_t behind_ns = 0;  ///< its clock is so much behind that of the first
  };
  void follow_new_ones();
  void read_recordings(News& news);
  [[nodiscard]] std::vector<std::uint32_t> joint_marking() const;
  [[nodiscard]] nlohmann::json processes() const;
  [[nodiscard]] nlohmann::json links() const;
  [[nodiscard]] nlohmann::json waits() const;
  [[nodiscard]] nlohmann::json subsystems() const;

  const Analysis& analysis_;
  Reached& reached_;
  project::DeploymentWatch watch_;
  std::vector<std::uint32_t> initial_;
  std::map<std::string, Followed> followed_;  ///< by the name of the socket
  std::optional<Clock::time_point> first_began_;
  std::int64_t time_ns_ = 0;
  std::uint64_t gone_firings_ = 0;  ///< of starts that are no longer followed
  bool any_ = false;                ///< a process was seen
  Clock::time_point seen_, read_{}, marking_told_{}, told_{}, subsystems_told_{};
};

}  // namespace tessera::server
