#pragma once

#include <vector>

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the section `properties`. entry may be null. Paths are looked up as far as the agent; only the
/// net knows the names after it.
///
/// Errors: E103 no kind; E104 form; E107 two kinds, or two properties with one name; those of
///         read_formula and read_claims.
[[nodiscard]] std::vector<Property> read_properties(const Entry* entry, const Model& model,
                                                    const AgentGroups& groups, Diagnostics& out);

}  // namespace tessera::spec
