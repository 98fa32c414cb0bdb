#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// Behaviours that could repeat for ever without time passing: one that repeats itself, or several
/// that follow one another in a cycle, if none of them waits. The result has one behaviour per
/// cycle. waits: per behaviour.
[[nodiscard]] std::vector<Index> standing_still(const Subsystem& subsystem, const std::vector<bool>& waits);

}  // namespace tessera::spec
