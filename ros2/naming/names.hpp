#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tessera/time.hpp"

/// The DDS names and qualities of service that ROS 2 uses.
namespace tessera::ros2 {

/// "/cmd_vel" for "cmd_vel" and "/cmd_vel"; empty and `error`: not a topic name.
[[nodiscard]] std::string full_topic_name(std::string_view written, std::string& error);
/// "rt/cmd_vel" for "/cmd_vel".
[[nodiscard]] std::string dds_topic_name(std::string_view topic);
/// "geometry_msgs::msg::dds_::Twist_" for "geometry_msgs/msg/Twist".
[[nodiscard]] std::string dds_type_name(std::string_view message);
/// "geometry_msgs/msg/Twist" for "geometry_msgs/Twist" and for itself; nullopt: no such form.
[[nodiscard]] std::optional<std::string> full_message_name(std::string_view written);
/// Whether the type is a service: "std_srvs/srv/SetBool".
[[nodiscard]] bool is_service_type(std::string_view type);
/// Whether the type is an action: "nav2_msgs/action/NavigateToPose".
[[nodiscard]] bool is_action_type(std::string_view type);
/// "std_srvs/srv/SetBool" for itself; nullopt: no such form.
[[nodiscard]] std::optional<std::string> full_service_name(std::string_view written);
/// The same for "nav2_msgs/action/NavigateToPose".
[[nodiscard]] std::optional<std::string> full_action_name(std::string_view written);
/// "rq/enableRequest" and "rr/enableReply" for the service "/enable".
[[nodiscard]] std::string dds_request_name(std::string_view service);
[[nodiscard]] std::string dds_reply_name(std::string_view service);
/// The two messages of a service: "std_srvs/srv/SetBool_Request", "std_srvs/srv/SetBool_Response".
[[nodiscard]] std::string request_type(std::string_view service_type);
[[nodiscard]] std::string response_type(std::string_view service_type);
/// The message that orders a goal: "nav2_msgs/action/NavigateToPose_Goal".
[[nodiscard]] std::string goal_type(std::string_view action_type);
/// Feedback and result as one buffer has them: "nav2_msgs/action/NavigateToPose".
[[nodiscard]] std::string progress_type(std::string_view action_type);

/// The services and topics of an action.
struct ActionNames {
  std::string send_goal, get_result, cancel_goal;  ///< "/go/_action/send_goal"
  std::string send_goal_type, get_result_type;     ///< "pkg/action/Go_SendGoal"
  std::string cancel_goal_type;                    ///< "action_msgs/srv/CancelGoal"
  std::string feedback, status;                    ///< "/go/_action/feedback"
  std::string feedback_type, status_type;          ///< "pkg/action/Go_FeedbackMessage"
};
[[nodiscard]] ActionNames names_of_action(std::string_view action, std::string_view action_type);

/// Whether a node can have the name: letters, digits and underscores.
[[nodiscard]] bool is_node_name(std::string_view name);
/// A node name made from a name or path: "robot_3_base" for "robot[3].base".
[[nodiscard]] std::string node_name_of(std::string_view path);

struct Qos {
  bool reliable = true;
  bool transient_local = false;
  int depth = 10;
  Duration lifespan{};  ///< how long a message that is not confirmed may still be sent; zero: for ever
};
/// Reads "default", "sensor", or their parts: "best_effort, transient_local, depth 5". nullopt and `error`:
/// any other text.
[[nodiscard]] std::optional<Qos> parse_qos(std::string_view text, std::string& error);

}  // namespace tessera::ros2
