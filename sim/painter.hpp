#pragma once

#include <memory>

#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Opens a world in order to draw recorded poses. The track, if there is one, lies on the floor.
///
/// Problem: the world does not open, its bodies differ from those of the recording, it has no such camera, or
/// this machine cannot render.
[[nodiscard]] Result<std::unique_ptr<WorldPainter>> open_painter(const WorldOptions& options,
                                                                 const PictureOptions& picture);

}  // namespace tessera::sim
