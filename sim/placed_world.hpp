#pragma once

#include <memory>

#include "sim/engine/physics.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The physics of the world file with the placed models in it, at its start. Scattered positions and varied
/// values are drawn from the seed.
///
/// Problem: as compose, load and scatter; a model varies an element that does not exist.
[[nodiscard]] Result<std::unique_ptr<Physics>> physics_of(const WorldOptions& options);

}  // namespace tessera::sim
