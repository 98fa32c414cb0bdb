#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Goals of actions: their names and states (docs/use/ros2.md).
namespace tessera::ros2 {

/// A UUID.
using GoalId = std::array<std::byte, 16>;

/// The state of a goal as buffers have it. The first seven are those of action_msgs/msg/GoalStatus.
enum class GoalState : std::uint8_t {
  none = 0,
  accepted = 1,
  executing = 2,
  canceling = 3,
  succeeded = 4,
  canceled = 5,
  aborted = 6,
  rejected = 7,
  gone = 8,     ///< the server was not there, has vanished, does not answer, or its answer cannot be read
  ordered = 9,  ///< sent, or waiting for the server
};

[[nodiscard]] constexpr bool is_end(GoalState state) {
  return state >= GoalState::succeeded && state <= GoalState::gone;
}
/// Whether the server works for the goal.
[[nodiscard]] constexpr bool is_under_way(GoalState state) {
  return state >= GoalState::accepted && state <= GoalState::canceling;
}
/// Whether a goal may come from one state into the other, if no state in between is missed.
[[nodiscard]] constexpr bool may_follow(GoalState before, GoalState after) {
  if (before == GoalState::none) return after == GoalState::ordered;
  if (before == GoalState::ordered)
    return after == GoalState::accepted || after == GoalState::rejected || after == GoalState::gone;
  return is_under_way(before) && after > before && after != GoalState::rejected && after <= GoalState::gone;
}

/// The answers of a server that is asked to cancel a goal (action_msgs/srv/CancelGoal).
enum class CancelCode : std::int8_t { good = 0, refused = 1, unknown_goal = 2, goal_has_ended = 3 };

}  // namespace tessera::ros2
