#pragma once

#include <memory>

#include "sim/engine/physics.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The physics of the world file with the placed models in it, at its start. What is scattered or varies is
/// drawn from the seed.
///
/// Problem: as compose, load and scatter; a model varies in something that is not there.
[[nodiscard]] Result<std::unique_ptr<Physics>> physics_of(const WorldOptions& options);

}  // namespace tessera::sim
