#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/analysis.hpp"
#include "server/tail.hpp"
#include "server/values.hpp"

namespace tessera::server {

/// Puts together what a running controller leaves behind: firings from its recording, the robot's path, and
/// the snapshots of its control socket. Ready to be sent.
class Follower {
 public:
  /// recording, path: that the run writes; empty: none that can be read.
  Follower(const std::filesystem::path& recording, const std::filesystem::path& path,
           const Analysis& analysis);

  struct News {
    nlohmann::json firings, values, pose, subsystems;  ///< data of the events; null: nothing new
    std::optional<std::vector<std::uint32_t>> marking;
    std::int64_t time_ns = 0;
    bool has_state = false, paused = false;
    std::uint64_t pauses = 0;  ///< how often it has come to rest
    std::string broke_at;
    bool more = false;  ///< there is more to read at once
  };
  /// snapshot: of the control socket, if there is a new one. What it says is told when everything that the
  /// run had recorded by then has been read.
  [[nodiscard]] News look(std::optional<nlohmann::json> snapshot);
  /// Until it is worth while to look again.
  static void rest();

 private:
  void add_firings(News& news);
  void add_pose(News& news);
  void add_snapshot(const nlohmann::json& snapshot, News& news);

  const Analysis& analysis_;
  RecordingTail recording_;
  GrowingFile path_;
  std::string path_line_;
  ValueReader values_;
  std::chrono::steady_clock::time_point marking_told_{}, pose_told_{}, subsystems_told_{};
  nlohmann::json pose_waiting_;
  std::optional<nlohmann::json> snapshot_;
  std::string values_seen_;
};

}  // namespace tessera::server
