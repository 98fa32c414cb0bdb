#pragma once

#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads `simulation: checks` into `checks` and `use_checks`: a list of { name: ..., never | always | at_end |
/// eventually: FORMULA } with `within` for eventually, and of { name: ..., at_most: { RESOURCE: AMOUNT } }. entry may
/// be null.
///
/// Errors: E102-E104 form; E115 a formula that cannot be read; E205, E206 a time or amount; E308 a name that is taken.
void read_checks(const Entry* entry, Simulation& simulation, Diagnostics& out);

/// Reads `simulation: measures`: NAME: NUMBER. entry may be null. Errors: as for checks.
[[nodiscard]] std::vector<WorldMeasure> read_world_measures(const Entry* entry, Diagnostics& out);

}  // namespace tessera::spec
