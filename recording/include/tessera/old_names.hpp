#pragma once

#include <string_view>

#include "tessera/transition_role.hpp"

namespace tessera {

/// What the name of a transition tells of its role, in a recording of a version that wrote no roles. The words
/// are those of these versions and stay, whatever words the layers write today. Nothing else reads names.
///
/// name: "robot.control.follow.t1", of the subsystem "robot.control"; empty: of none, as "robot.t_in". The
/// channel of a transition is not told.
[[nodiscard]] TransitionRole role_of_old_name(std::string_view name, std::string_view subsystem);

}  // namespace tessera
