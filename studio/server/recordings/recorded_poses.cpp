// The poses in a recording, for Recordings.
#include <filesystem>

#include "project/files/files.hpp"
#include "server/http/json_text.hpp"
#include "server/recordings/pose_track.hpp"
#include "server/recordings/recording_stream.hpp"
#include "server/recordings/recordings.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The part of the poses that is shown.
class PosePart {
 public:
  explicit PosePart(Recordings::Span span) : span_(span) {}

  void begin(const Recording& header) { track_.begin(header); }
  /// false: the part is complete.
  [[nodiscard]] bool add(const Recording::Entry& entry) {
    if (entry.event.kind() != Event::Kind::poses) return true;
    if (entry.event.time_ns > span_.to_ns) return false;
    // Poses before the span are shown at its beginning.
    if (entry.event.time_ns >= span_.from_ns) show();
    track_.take(entry);
    if (entry.event.time_ns < span_.from_ns) return true;
    show();
    until_ns_ = entry.event.time_ns;
    return bytes_ < Recordings::most_pose_bytes;
  }
  void end(bool complete) {
    show();
    if (complete) until_ns_ = std::max(until_ns_, span_.to_ns);
  }
  [[nodiscard]] json take() { return {{"frames", std::move(frames_)}, {"until", until_ns_}}; }

 private:
  void show() {
    const std::optional<PoseTrack::Frame> frame = track_.next_frame();
    if (!frame) return;
    bytes_ += frame->bytes.size() + 24;
    frames_.push_back({frame->time_ns, frame->bytes});
  }

  const Recordings::Span span_;
  PoseTrack track_;
  json frames_ = json::array();
  std::int64_t until_ns_ = INT64_MIN;
  std::size_t bytes_ = 0;
};

}  // namespace

std::optional<std::string> Recordings::poses(const std::string& name, Span span) const {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  PosePart part(span);
  read_part(found->second, part);
  return text_of(part.take());
}

std::optional<std::string> Recordings::scene(const std::string& hash) const {
  if (!is_scene_hash(hash)) return std::nullopt;
  for (const auto& [name, file] : files()) {
    const fs::path scene = scene_file(file.string(), hash);
    std::error_code ignored;
    if (fs::symlink_status(scene, ignored).type() != fs::file_type::regular) continue;
    return project::content_of(scene);
  }
  return std::nullopt;
}

}  // namespace tessera::server
