#pragma once

#include <vector>

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads `simulation: models`: WHO: { model: FILE, ... }. WHO is an agent (`arm`, `robot[3]`), a whole fleet
/// (`robot[*]`), or a thing that is no agent (`table`, or `box[*]` with a `count`). There is one placement for
/// each of them in the result. entry may be null.
///
/// Errors: E101 an unknown agent; E103 a missing key; E104, E205, E206 values; E107 two ways to place; E112 an
///         index that does not fit; E303 an agent that the fleet does not have; E308 a model placed twice.
[[nodiscard]] std::vector<ModelPlacement> read_placements(const Entry* entry, const Model& model,
                                                          const AgentGroups& groups, Diagnostics& out);

}  // namespace tessera::spec
