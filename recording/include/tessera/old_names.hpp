#pragma once

#include <string_view>

#include "tessera/transition_role.hpp"

namespace tessera {

/// Derives the role of a transition from its name, for recordings of versions that wrote no roles. It keeps
/// the words of those versions, whatever words the layers write today. No other function reads names.
///
/// name: "robot.control.follow.t1", of the subsystem "robot.control"; an empty subsystem: of none, as
/// "robot.t_in". The result names no channel.
[[nodiscard]] TransitionRole role_of_old_name(std::string_view name, std::string_view subsystem);

}  // namespace tessera
