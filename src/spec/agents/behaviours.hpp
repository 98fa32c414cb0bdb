#pragma once

#include <vector>

#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the behaviours of a subsystem. Everything that `scope` refers to has been read.
///
/// Errors: E101 unknown behaviour, buffer or condition; E103 no behaviour; E105-E107
///         names; those of conditions.
[[nodiscard]] std::vector<Behaviour> read_behaviours(const Entry& entry, const ConditionScope& scope,
                                                     Diagnostics& out);

}  // namespace tessera::spec
