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

/// The same with the picture of the track on the floor, which cameras of a run do not see. It can be drawn, and
/// is not to be simulated. Models that vary are as their files say.
[[nodiscard]] Result<std::unique_ptr<Physics>> physics_to_look_at(const WorldOptions& options);

}  // namespace tessera::sim
