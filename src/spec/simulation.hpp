#pragma once

#include <optional>

#include "spec/document.hpp"
#include "spec/fleets.hpp"
#include "spec/model.hpp"

namespace tessera::spec {

/// The section `simulation`. entry may be null.
///
/// Errors: E103 no world; E104-E206 the track; those of drivers.
[[nodiscard]] std::optional<Simulation> read_simulation(const Entry* entry, const Model& model,
                                                        const Groups& groups, Diagnostics& out);

/// The section `properties`: kept for the verifier, whose language is not looked into here. entry may be
/// null.
///
/// Errors: E103 no kind; E104 form; E107 two kinds, or two properties of one name.
[[nodiscard]] std::vector<Property> read_properties(const Entry* entry, Diagnostics& out);

}  // namespace tessera::spec
