#include "server/recordings/pose_track.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace tessera::server {

using nlohmann::json;

void PoseTrack::begin(const Recording& header) {
  if (!header.scene) return;
  json bodies = json::array();
  for (const Recording::Scene::Body& body : header.scene->bodies)
    bodies.push_back(json::array({body.name, body.agent}));
  json scene{{"hash", header.scene->hash}, {"bodies", std::move(bodies)}};
  if (scene == scene_) return;  // the next segment of the same run
  scene_ = std::move(scene);
  recorded_.emplace(header.scene->bodies.size());
  shown_.emplace(header.scene->bodies.size());
  const std::vector<replay::Robot> robots = replay::robots_of(*header.scene);
  robot_ = robots.size() == 1 ? std::optional(robots.front().body) : std::nullopt;
}

void PoseTrack::take(const Recording::Entry& entry) {
  if (entry.event.kind() != Event::Kind::poses || !recorded_) return;
  static_cast<void>(recorded_->take(entry.text));
  time_ns_ = entry.event.time_ns;
  changed_ = recorded_->known();
  if (changed_ && robot_) point_ = replay::from_above(time_ns_, pose_of(recorded_->poses()[*robot_]));
}

std::optional<PoseTrack::Frame> PoseTrack::next_frame() {
  if (!std::exchange(changed_, false)) return std::nullopt;
  const std::string_view frame = shown_->encode(time_ns_, recorded_->poses());
  if (frame.empty()) return std::nullopt;
  shown_ns_ = time_ns_;
  return Frame{time_ns_, base64_of(frame)};
}

std::optional<PoseTrack::Frame> PoseTrack::last_whole() const {
  if (!shown_) return std::nullopt;
  const std::string frame = shown_->last_whole();
  return frame.empty() ? std::nullopt : std::optional(Frame{shown_ns_, base64_of(frame)});
}

std::string base64_of(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t at) {
    return at < bytes.size() ? static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[at])) : 0U;
  };
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::uint32_t three = byte(at) << 16U | byte(at + 1) << 8U | byte(at + 2);
    text += digits[three >> 18U];
    text += digits[three >> 12U & 63U];
    text += at + 1 < bytes.size() ? digits[three >> 6U & 63U] : '=';
    text += at + 2 < bytes.size() ? digits[three & 63U] : '=';
  }
  return text;
}

}  // namespace tessera::server
