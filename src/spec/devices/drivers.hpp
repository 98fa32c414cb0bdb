#pragma once

#include <vector>

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Whether drivers belong to devices of the robot or of the simulated world.
enum class Devices : std::uint8_t { real, simulated };

/// Reads PATH: { KIND: TARGET, OPTION: VALUE ... } pairs. entry may be null. PATH names a real buffer, or a
/// subsystem if one C++ class serves all its real buffers. A path with [*] stands for every agent; {i} in
/// its target and in texts is replaced by the number of the agent.
///
/// Errors: E101 and E112 paths; E101 unknown kind; E103 no kind; E104 form; E210 a kind that does not fit
///         the buffer; E308 two drivers for one real buffer.
[[nodiscard]] std::vector<Driver> read_drivers(const Entry* entry, Devices devices, const Model& model,
                                               const AgentGroups& groups, Diagnostics& out);

}  // namespace tessera::spec
