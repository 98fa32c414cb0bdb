#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tessera/goal_life.hpp"

/// Goals of actions: their names, and the steps of their life (docs/use/ros2.md).
namespace tessera::ros2 {

/// A UUID.
using GoalId = std::array<std::byte, 16>;

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
