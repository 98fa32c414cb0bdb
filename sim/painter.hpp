#pragma once

#include <memory>

#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Opens a world to be drawn as it was recorded. The track, if there is one, lies on the floor.
///
/// Problem: the world does not open, has other bodies than those of the recording or no such camera, or nothing
/// can be rendered on this machine.
[[nodiscard]] Result<std::unique_ptr<WorldPainter>> open_painter(const WorldOptions& options,
                                                                 const PictureOptions& picture);

}  // namespace tessera::sim
