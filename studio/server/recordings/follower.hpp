#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/analysis/analysis.hpp"
#include "server/http/path.hpp"
#include "server/recordings/growing_file.hpp"
#include "server/recordings/tail.hpp"

namespace tessera::server {

/// Combines what is known about a running controller: firings and values from its recording, the robot's
/// path, and the snapshots of its control socket. The results are ready to be sent.
class Follower {
 public:
  /// path: the file that the run writes; empty: there is none that can be read.
  Follower(RecordingStream::Source recording, const std::filesystem::path& path, const Analysis& analysis);

  struct News {
    nlohmann::json firings, values, pose, subsystems;  ///< data of the events; null: nothing new
    std::vector<PathPoint> path;                       ///< new points of the path
    std::optional<std::vector<std::uint32_t>> marking;
    std::int64_t time_ns = 0;
    bool has_state = false, paused = false;
    bool rested = false;  ///< the run has come to rest, perhaps again
    std::string broke_at;
    bool more = false;  ///< there is more to read at once
  };
  /// snapshot: of the control socket, if there is a new one. It is reported after everything has been read
  /// that the run had recorded by then.
  /// last: nothing is kept for later.
  [[nodiscard]] News look(std::optional<nlohmann::json> snapshot, bool last);
  /// Waits until it is worthwhile to look again.
  static void rest();

 private:
  void add_firings(News& news);
  void add_path(News& news, bool at_once);
  void add_values(News& news, bool at_once);
  void add_snapshot(const nlohmann::json& snapshot, News& news);

  RecordingTail recording_;
  GrowingFile path_;
  PathReader points_;
  std::chrono::steady_clock::time_point marking_told_{}, values_told_{}, pose_told_{}, subsystems_told_{};
  std::optional<PathPoint> pose_waiting_;
  std::optional<nlohmann::json> snapshot_;
  std::uint64_t pauses_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace tessera::server
