#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The named elements of a model.
namespace tessera::sim {

/// "sensor", "site", ...
[[nodiscard]] const char* word_for(mjtObj type);
[[nodiscard]] int count_of(const mjModel& model, mjtObj type);
/// Empty: it has no name. An actuator without a name has that of the joint that it moves alone.
[[nodiscard]] std::string name_of(const mjModel& model, mjtObj type, int id);
/// Of all elements that have one, in the order of the model.
[[nodiscard]] std::vector<std::string> names_of(const mjModel& model, mjtObj type);

/// The element that a driver of `agent` calls `name`: `agent/name` if there is one, which is a part of the
/// agent's own model; otherwise `name` as it stands. A name that begins with `/` is never of a model.
[[nodiscard]] std::optional<int> find_element(const mjModel& model, mjtObj type, std::string_view agent,
                                              const std::string& name);

/// The names that `agent` can use for elements, in the shortest form: parts of its own model first. Parts
/// of other agents' models come last, with their full names.
[[nodiscard]] std::vector<std::string> names_for(const mjModel& model, mjtObj type, std::string_view agent);

/// How many numbers a joint's position has: free 7, ball 4, else 1; its velocity: free 6, ball 3, else 1.
[[nodiscard]] int position_size(const mjModel& model, int joint);
[[nodiscard]] int velocity_size(const mjModel& model, int joint);

}  // namespace tessera::sim
