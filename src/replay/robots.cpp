#include "replay/robots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

namespace tessera::replay {
namespace {

/// The vector as the world sees it.
[[nodiscard]] std::array<double, 3> turned(const std::array<double, 4>& q, const std::array<double, 3>& v) {
  const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const std::array<double, 3> axis{q[1], q[2], q[3]};
  std::array<double, 3> once = cross(axis, v);
  for (double& part : once) part *= 2;
  const std::array<double, 3> twice = cross(axis, once);
  std::array<double, 3> result{};
  for (std::size_t at = 0; at < 3; ++at) result[at] = v[at] + q[0] * once[at] + twice[at];
  return result;
}

[[nodiscard]] std::string file_of(const std::string& recording) {
  std::error_code ignored;
  return std::filesystem::is_directory(recording, ignored)
             ? (std::filesystem::path(recording) / recording_file_name).string()
             : recording;
}

}  // namespace

std::vector<Robot> robots_of(const Recording::Scene& scene) {
  const bool has_agents = std::ranges::any_of(
      scene.bodies, [](const Recording::Scene::Body& body) { return !body.agent.empty(); });
  std::vector<Robot> robots;
  std::vector<std::string> agents;
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    const Recording::Scene::Body& body = scene.bodies[index];
    if (body.parent || (has_agents && body.agent.empty())) continue;
    robots.push_back({body.agent.empty() ? body.name : body.agent, index});
    agents.push_back(body.agent);
  }
  for (std::size_t index = 0; index < robots.size(); ++index)
    if (std::ranges::count(agents, agents[index]) > 1)
      robots[index].name = scene.bodies[robots[index].body].name;
  return robots;
}

std::vector<std::size_t> parts_of_robots(const Recording::Scene& scene) {
  std::vector<bool> is_part(scene.bodies.size());
  for (const Robot& robot : robots_of(scene)) is_part[robot.body] = true;
  std::vector<std::size_t> parts;
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    std::size_t above = index;
    for (std::size_t steps = 0; !is_part[above] && scene.bodies[above].parent && steps < scene.bodies.size();
         ++steps)
      above = *scene.bodies[above].parent;
    if (is_part[above]) parts.push_back(index);
  }
  return parts;
}

RobotPoint from_above(std::int64_t time_ns, const BodyPose& pose) {
  const std::array<double, 3> ahead = turned(pose.rotation, {1, 0, 0});
  return {time_ns, pose.position_m[0], pose.position_m[1], std::atan2(ahead[1], ahead[0])};
}

RobotPoint from_above(std::int64_t time_ns, const BodyPose& pose, const Recording::Scene::Eye& eye) {
  RobotPoint point = from_above(time_ns, pose);
  const std::array<double, 3> way = turned(pose.rotation, {eye.x_m, eye.y_m, eye.z_m});
  point.x_m += way[0];
  point.y_m += way[1];
  return point;
}

PoseReader::PoseReader(const std::string& recording)
    : file_(file_of(recording), GrowingRecording::From::oldest) {}

const Recording::Entry* PoseReader::next() {
  while (at_ == entries_.size())
    if (!read_on()) return nullptr;
  const Recording::Entry& entry = entries_[at_++];
  follow(entry);
  return &entry;
}

/// false: there is nothing more.
bool PoseReader::read_on() {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  entries_.clear();
  at_ = 0;
  const GrowingRecording::Piece read = file_.next(piece);
  if (read.bytes.empty()) return false;
  if (read.begins || !reader_) reader_ = std::make_unique<RecordingReader>();
  reader_->feed(read.bytes);
  entries_ = std::exchange(reader_->recording().entries, {});
  return true;
}

void PoseReader::follow(const Recording::Entry& entry) {
  const std::optional<Recording::Scene>& scene = reader_->recording().scene;
  if (entry.event.kind() != Event::Kind::poses || !scene) return;
  if (!decoder_ || scene_ != scene->hash) {
    decoder_.emplace(scene->bodies.size());
    scene_ = scene->hash;
  }
  static_cast<void>(decoder_->take(entry.text));
  poses_.clear();
  if (!decoder_->known()) return;
  for (const RoundedPose& pose : decoder_->poses()) poses_.push_back(pose_of(pose));
}

}  // namespace tessera::replay
