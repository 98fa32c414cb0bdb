#pragma once

#include <memory>
#include <string>

#include "sim/coppelia/lock_step.hpp"
#include "tessera/world_state.hpp"

namespace tessera::coppelia {

/// The scene for C++ drivers of `agent`. Sites are objects like all others.
[[nodiscard]] std::shared_ptr<WorldState> view_of(std::shared_ptr<LockStep> scene, std::string agent);

}  // namespace tessera::coppelia
