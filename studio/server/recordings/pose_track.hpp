#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "replay/robots.hpp"
#include "tessera/poses.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// Follows the poses in a recording, in any number of segments, and makes frames of them for a page. They
/// differ from the recorded frames, because a page may begin anywhere and does not get all of them.
///
/// Threads: one at a time.
class PoseTrack {
 public:
  /// A segment of the recording begins.
  void begin(const Recording& header);
  /// Any entry of the recording.
  void take(const Recording::Entry& entry);

  /// {"hash", "bodies": [[name, agent]...]}; null: the recording has no poses.
  [[nodiscard]] const nlohmann::json& scene() const { return scene_; }
  [[nodiscard]] bool has_one_robot() const { return robot_.has_value(); }
  /// The pose of the only robot, seen from above; nullopt: there is no robot or there are several, or the
  /// last entry had no poses of it.
  [[nodiscard]] std::optional<replay::RobotPoint> take_point() { return std::exchange(point_, std::nullopt); }
  /// A frame (tessera/poses.hpp), base64, and its time.
  struct Frame {
    std::int64_t time_ns = 0;
    std::string bytes;
  };
  /// The changes since the last frame; nullopt: there are none, or the poses are unknown now.
  [[nodiscard]] std::optional<Frame> next_frame();
  /// The same poses as after the last frame, with its number, for a page that lacks the frames before.
  [[nodiscard]] std::optional<Frame> last_whole() const;

 private:
  nlohmann::json scene_;
  std::optional<PoseDecoder> recorded_;
  std::optional<PoseEncoder> shown_;
  std::optional<std::size_t> robot_;  // body of the only one
  std::optional<replay::RobotPoint> point_;
  std::int64_t time_ns_ = 0, shown_ns_ = 0;
  bool changed_ = false;
};

[[nodiscard]] std::string base64_of(std::string_view bytes);

}  // namespace tessera::server
