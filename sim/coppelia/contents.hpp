#pragma once

#include <string>

#include "tessera/device.hpp"

namespace tessera::coppelia {

/// What the scene of a server offers, as `tessera world` reads it. Loads the scene if it is named, and closes
/// it again. Errors: as LockStep.
[[nodiscard]] std::string contents_as_json(const WorldServer& server);

}  // namespace tessera::coppelia
