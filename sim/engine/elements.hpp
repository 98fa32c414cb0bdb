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
/// Empty: it has no name. An actuator without a name is named after the joint that it moves alone.
[[nodiscard]] std::string name_of(const mjModel& model, mjtObj type, int id);
/// The names of all elements that have one, in the order of the model.
[[nodiscard]] std::vector<std::string> names_of(const mjModel& model, mjtObj type);

/// The element that a driver of `agent` calls `name`: `agent/name` if it exists, which is a part of the
/// agent's own model; otherwise `name` itself. A name that begins with `/` is never a part of a model.
[[nodiscard]] std::optional<int> find_element(const mjModel& model, mjtObj type, std::string_view agent,
                                              const std::string& name);

/// The names that `agent` can use for elements, in the shortest form: parts of its own model first. Parts of
/// other agents' models come last, with their full names.
[[nodiscard]] std::vector<std::string> names_for(const mjModel& model, mjtObj type, std::string_view agent);

/// The size of a joint's position: free 7, ball 4, else 1; of its velocity: free 6, ball 3, else 1.
[[nodiscard]] int position_size(const mjModel& model, int joint);
[[nodiscard]] int velocity_size(const mjModel& model, int joint);

}  // namespace tessera::sim
