#pragma once

#include <optional>

#include "sim/compose/compose.hpp"
#include "sim/mjcf/model_file.hpp"

namespace tessera::sim {

/// Adds the values that the keyframe of a placement gives its instance; none if it names no keyframe. Error:
/// the file has no such keyframe.
[[nodiscard]] std::optional<Problem> add_initial_values(const ModelFile& file, const Placement& placement,
                                                        InitialValues& values);

/// The state at the start of a compiled world: that of the world file, and the values of keyframes.
[[nodiscard]] InitialState initial_state(const mjModel& model, const InitialValues& values);

}  // namespace tessera::sim
