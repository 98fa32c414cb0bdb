#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "ros2/actions/goal.hpp"

namespace tessera::ros2 {

/// The beginning of the names of all goals of one client in one run.
using GoalPrefix = std::array<std::byte, 8>;

/// Identifies the client in the runs of a controller with that process: it is the same whoever asks, as long as the
/// process exists, and another for every other process.
[[nodiscard]] GoalPrefix goal_prefix(int process, const std::string& client);
/// A name with that beginning, and random bytes.
[[nodiscard]] GoalId new_goal_id(const GoalPrefix& prefix);
[[nodiscard]] bool has_prefix(const GoalId& id, const GoalPrefix& prefix);

}  // namespace tessera::ros2
