#pragma once

#include <memory>
#include <string>

#include "sim/simulation.hpp"
#include "tessera/world_state.hpp"

namespace tessera::sim {

/// The simulation for drivers of `agent` that are C++ classes.
[[nodiscard]] std::shared_ptr<WorldState> view_of_world(std::shared_ptr<Simulation> simulation,
                                                        std::string agent);

}  // namespace tessera::sim
