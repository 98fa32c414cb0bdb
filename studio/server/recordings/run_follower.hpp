#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/analysis/analysis.hpp"
#include "server/recordings/recording_tail.hpp"
#include "server/recordings/robot_path.hpp"
#include "tessera/control_messages.hpp"

namespace tessera::server {

/// Adds the subsystems and channels of the snapshot to the lists of an event `subsystems`: without the memory,
/// which the page takes from the values of the recording.
void add_subsystems(const Snapshot& snapshot, nlohmann::json& event);

/// Collects the state of a running controller: firings and values from its recording, the robot's path, and
/// the snapshots of its control socket. The results are ready to be sent.
class RunFollower {
 public:
  /// reached: gets what the run reaches of the net; must outlive this object.
  RunFollower(RecordingStream::Source recording, const Analysis& analysis, Reached* reached = nullptr);

  struct News {
    nlohmann::json firings, values, arrays, pose, poses, subsystems,
        notices;                  ///< data of the events; null: nothing new
    nlohmann::json scene;         ///< of the event; null: no new one
    nlohmann::json whole_poses;   ///< with `poses`: {"t", "frame"} for a new page
    std::vector<PathPoint> path;  ///< new points of the path
    std::vector<std::pair<std::string, std::string>> parameters;  ///< RecordingTail::Batch::parameters
    bool lacks_parameters = false;                                ///< RecordingTail::Batch::lacks_parameters
    std::optional<std::vector<std::uint32_t>> marking;
    std::int64_t time_ns = 0;
    std::uint64_t total_firings = 0;  ///< firings read so far; 0: no new ones
    bool has_state = false, paused = false;
    bool rested = false;  ///< the run has come to rest, perhaps again
    std::string broke_at;
    bool more = false;  ///< there is more to read at once
  };
  /// snapshot: of the control socket, if there is a new one. It is reported after everything that the run had
  /// recorded by then.
  /// last: nothing is kept for later.
  [[nodiscard]] News poll(std::optional<Snapshot> snapshot, bool last);
  /// The time until the next look is worthwhile.
  static void rest();

 private:
  /// Returns the new points of the path.
  [[nodiscard]] std::vector<PathPoint> add_firings(News& news);
  void add_path(std::vector<PathPoint> path, News& news, bool at_once);
  void add_values(News& news, bool at_once);
  void add_arrays(News& news, bool at_once);
  void add_poses(News& news, bool at_once);
  void add_snapshot(const Snapshot& snapshot, News& news);

  RecordingTail recording_;
  std::chrono::steady_clock::time_point marking_told_{}, values_told_{}, arrays_told_{}, pose_told_{},
      poses_told_{}, subsystems_told_{};
  bool scene_told_ = false;
  std::optional<PathPoint> pose_waiting_;
  std::optional<Snapshot> snapshot_;
  std::vector<RecordingTail::Arrived> arrivals_;  ///< not told yet
  std::uint64_t arrivals_dropped_ = 0;
  std::uint64_t pauses_ = 0, total_firings_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace tessera::server
