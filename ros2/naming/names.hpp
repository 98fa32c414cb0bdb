#pragma once

#include <optional>
#include <string>
#include <string_view>

/// How ROS 2 uses the names and qualities of DDS.
namespace tessera::ros2 {

/// "/cmd_vel" of "cmd_vel" and "/cmd_vel"; empty and `error`: no name of a topic.
[[nodiscard]] std::string full_topic_name(std::string_view written, std::string& error);
/// "rt/cmd_vel" of "/cmd_vel".
[[nodiscard]] std::string dds_topic_name(std::string_view topic);
/// "geometry_msgs::msg::dds_::Twist_" of "geometry_msgs/msg/Twist".
[[nodiscard]] std::string dds_type_name(std::string_view message);
/// "geometry_msgs/Twist" and "geometry_msgs/msg/Twist" are "geometry_msgs/msg/Twist"; nullopt: no such form.
[[nodiscard]] std::optional<std::string> full_message_name(std::string_view written);
/// Whether the type is a service: "std_srvs/srv/SetBool".
[[nodiscard]] bool is_service_type(std::string_view type);
/// "std_srvs/srv/SetBool" of itself; nullopt: no such form.
[[nodiscard]] std::optional<std::string> full_service_name(std::string_view written);
/// "rq/enableRequest" and "rr/enableReply" of the service "/enable".
[[nodiscard]] std::string dds_request_name(std::string_view service);
[[nodiscard]] std::string dds_reply_name(std::string_view service);
/// The two messages of a service: "std_srvs/srv/SetBool_Request", "std_srvs/srv/SetBool_Response".
[[nodiscard]] std::string request_type(std::string_view service_type);
[[nodiscard]] std::string response_type(std::string_view service_type);
/// Whether a node can have the name: letters, digits and underscores.
[[nodiscard]] bool is_node_name(std::string_view name);
/// A name for a node, made of a name or path: "robot_3_base" of "robot[3].base".
[[nodiscard]] std::string node_name_of(std::string_view path);

struct Qos {
  bool reliable = true;
  bool transient_local = false;
  int depth = 10;
};
/// Reads "default", "sensor", or their parts: "best_effort, transient_local, depth 5". nullopt and `error`:
/// something else.
[[nodiscard]] std::optional<Qos> parse_qos(std::string_view text, std::string& error);

}  // namespace tessera::ros2
