#pragma once

#include <optional>
#include <vector>

#include "spec/agents/paths.hpp"
#include "spec/model/model.hpp"
#include "spec/properties/property_text.hpp"

namespace tessera::spec {

/// The claims of a property, one for each agent of a fleet. A path with [i], [i+1] or [*] stands for every
/// agent, and i is the same everywhere in the text. Within any(...) and all(...), [*] stands for the agents
/// over which they range. Claims about agents past the end of a fleet that is no ring are left out.
///
/// Errors: E101 unknown agent; E112 and E303 indices; E307 i over fleets of different sizes; E114 any or all
/// without [*], or more than a million paths. Empty after an error.
[[nodiscard]] std::vector<Claim> read_claims(const Formula& what, const std::optional<Formula>& then,
                                             const PathLookup& lookup, Diagnostics& out);

}  // namespace tessera::spec
