#include "bag/pose_channel.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "bag/event_channels.hpp"
#include "ros2/codec/cdr.hpp"

namespace tessera::bag {

PoseChannel::PoseChannel(const Recording::Scene& scene)
    : decoder_(scene.bodies.size()), last_(scene.bodies.size()) {
  for (const Recording::Scene::Body& body : scene.bodies) names_.push_back(body.name);
}

ChannelPlan PoseChannel::plan() {
  std::string definition = "geometry_msgs/TransformStamped[] transforms";
  for (const char* part :
       {"geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
        "geometry_msgs/Transform transform",
        "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id", time_definition,
        "geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
        "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z",
        "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w"})
    definition += std::string(definition_line) + part;
  return {{0, "tf2_msgs/msg/TFMessage", "ros2msg", definition + "\n"}, {0, 0, "/tf", "cdr", {}}};
}

std::optional<std::string> PoseChannel::message_of(const Recording::Entry& frame) {
  static_cast<void>(decoder_.take(frame.text));
  if (!decoder_.known()) return std::nullopt;
  const bool whole = frame.text.starts_with('\1');
  std::vector<std::size_t> moved;
  for (std::size_t body = 0; body < names_.size(); ++body)
    if (whole || !(decoder_.poses()[body] == last_[body])) moved.push_back(body);
  last_ = decoder_.poses();
  const RosTime time = ros_time(frame.event.time_ns);
  std::vector<std::byte> message;
  ros2::CdrWriter writer(message);
  writer.length(static_cast<std::uint32_t>(moved.size()));
  for (const std::size_t body : moved) {
    const BodyPose pose = pose_of(last_[body]);
    const auto& [w, i, j, k] = pose.rotation;
    writer.number(&time.sec, sizeof time.sec);
    writer.number(&time.nanosec, sizeof time.nanosec);
    writer.text("world");
    writer.text(names_[body]);
    for (const double number : {pose.position_m[0], pose.position_m[1], pose.position_m[2], i, j, k, w})
      writer.number(&number, sizeof number);
  }
  writer.finish();
  return std::string(reinterpret_cast<const char*>(message.data()), message.size());
}

}  // namespace tessera::bag
