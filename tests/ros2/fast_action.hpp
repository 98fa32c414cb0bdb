#pragma once

#include "fast_peer.hpp"

/// The messages of action_tutorials_interfaces/action/Fibonacci, field after field, with the header of
/// rmw_cyclonedds_cpp where they are requests and replies.
namespace fast {

using Uuid = std::array<std::uint8_t, 16>;

struct SendGoalRequest {
  static constexpr const char* name =
      "action_tutorials_interfaces::action::dds_::Fibonacci_SendGoal_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  Uuid uuid{};
  std::int32_t order = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, uuid, order);
  }
};
struct SendGoalResponse {
  static constexpr const char* name =
      "action_tutorials_interfaces::action::dds_::Fibonacci_SendGoal_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  bool accepted = false;
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, accepted, sec, nanosec);
  }
};
struct GetResultRequest {
  static constexpr const char* name =
      "action_tutorials_interfaces::action::dds_::Fibonacci_GetResult_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  Uuid uuid{};
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, uuid);
  }
};
struct GetResultResponse {
  static constexpr const char* name =
      "action_tutorials_interfaces::action::dds_::Fibonacci_GetResult_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::int8_t status = 0;
  std::vector<std::int32_t> numbers{};
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, status, numbers);
  }
};
struct CancelGoalRequest {
  static constexpr const char* name = "action_msgs::srv::dds_::CancelGoal_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  Uuid uuid{};
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, uuid, sec, nanosec);
  }
};
/// With one goal, or none if its code is not 0.
struct CancelGoalResponse {
  static constexpr const char* name = "action_msgs::srv::dds_::CancelGoal_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::int8_t code = 0;
  Uuid uuid{};
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  template <class Archive>
  void fields(Archive& all) {
    std::uint32_t count = code == 0 ? 1 : 0;
    all(client, sequence, code, count);
    if (count > 0) all(uuid, sec, nanosec);
  }
};
struct Feedback {
  static constexpr const char* name = "action_tutorials_interfaces::action::dds_::Fibonacci_FeedbackMessage_";
  Uuid uuid{};
  std::vector<std::int32_t> numbers{};
  template <class Archive>
  void fields(Archive& all) {
    all(uuid, numbers);
  }
};
struct GoalStatus {
  Uuid uuid{};
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::int8_t status = 0;
};
struct StatusArray {
  static constexpr const char* name = "action_msgs::msg::dds_::GoalStatusArray_";
  std::vector<GoalStatus> goals{};
  template <class Archive>
  void fields(Archive& all) {
    auto count = static_cast<std::uint32_t>(goals.size());
    all(count);
    goals.resize(count);
    for (GoalStatus& one : goals) all(one.uuid, one.sec, one.nanosec, one.status);
  }
};

}  // namespace fast
