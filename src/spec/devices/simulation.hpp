#pragma once

#include <optional>

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the section `simulation`. entry may be null.
///
/// Errors: E103 no world, though a driver or a track needs one; E104-E206 the track; those of drivers and
///         of placed models.
[[nodiscard]] std::optional<Simulation> read_simulation(const Entry* entry, const Model& model,
                                                        const AgentGroups& groups, Diagnostics& out);

}  // namespace tessera::spec
