#pragma once

#include <vector>

#include "spec/agents/defaults.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the behaviours of a subsystem. Everything that `scope` refers to has been read.
///
/// Their `next` is as in the file, without what `on_error` adds, and without implied entries.
/// Errors: E101 unknown behaviour, buffer or condition; E103 no behaviour; E105-E107
///         names; those of conditions and of lists of buffers.
[[nodiscard]] std::vector<Behaviour> read_behaviours(const Entry& entry, const ConditionScope& scope,
                                                     SubsystemDefaults& defaults, Diagnostics& out);

}  // namespace tessera::spec
