#pragma once

#include <string>

#include "tessera/device.hpp"

namespace tessera::coppelia {

/// The elements of the server's scene, for `tessera world`. Loads the scene if the server names one, and
/// closes it again. Errors: as LockStep.
[[nodiscard]] std::string contents_as_json(const WorldServer& server);

}  // namespace tessera::coppelia
