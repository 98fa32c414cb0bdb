#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// The life of a goal: what a subsystem that has ordered one is told of it. The numbers are those of the field
/// `state` of its progress; the first seven are those of a goal of an action in ROS 2.
namespace tessera {

enum class GoalState : std::uint8_t {
  none,  ///< nothing was ordered
  accepted,
  executing,
  canceling,
  succeeded,
  canceled,
  aborted,
  rejected,
  gone,    ///< who serves it has vanished, or was never there
  ordered  ///< not answered yet
};

inline constexpr std::size_t goal_state_count = 10;
inline constexpr std::array<std::string_view, goal_state_count> goal_state_names{
    "none",     "accepted", "executing", "canceling", "succeeded",
    "canceled", "aborted",  "rejected",  "gone",      "ordered"};

/// Whether nothing comes after it, except a new order.
[[nodiscard]] constexpr bool is_end(GoalState state) {
  return state >= GoalState::succeeded && state <= GoalState::gone;
}

/// Whether a goal in the state `before` may be told to be in `after`: it is the same state, or a later one of its
/// life. A reader may miss the states in between.
[[nodiscard]] constexpr bool can_follow(GoalState before, GoalState after) {
  if (before == after) return true;
  switch (before) {
    case GoalState::ordered:
      return after != GoalState::none;
    case GoalState::accepted:
    case GoalState::executing:
    case GoalState::canceling:
      // Their numbers are in the order of the life. Only what was not accepted is rejected.
      return after > before && after != GoalState::rejected && after != GoalState::ordered;
    default:
      return false;
  }
}

}  // namespace tessera
