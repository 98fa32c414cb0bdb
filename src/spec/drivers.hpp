#pragma once

#include <vector>

#include "spec/document.hpp"
#include "spec/fleets.hpp"
#include "spec/model.hpp"

namespace tessera::spec {

/// Whether drivers stand for devices of the robot or of the simulated world.
enum class Devices : std::uint8_t { real, simulated };

/// PATH: { KIND: TARGET, OPTION: NUMBER ... } pairs. entry may be null. A path with [*] stands for every
/// agent, and {i} in its target for the number of the agent.
///
/// Errors: E101 and E112 paths; E101 unknown kind; E103 no kind; E104 form; E210 a kind that does not fit the
/// buffer;
///         E308 two drivers for one real buffer.
[[nodiscard]] std::vector<Driver> read_drivers(const Entry* entry, Devices devices, const Model& model,
                                               const Groups& groups, Diagnostics& out);

}  // namespace tessera::spec
