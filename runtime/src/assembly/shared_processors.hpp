#pragma once

#include <span>

#include "subsystem/subsystem_parts.hpp"

namespace tessera {

/// Finds the subsystems that stay on one processor together, as `realtime` says.
void find_shared_processors(std::span<SubsystemParts> parts);

}  // namespace tessera
