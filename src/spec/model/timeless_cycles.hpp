#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// Behaviours in which a run could go on for ever without time passing: one that repeats, or several that
/// follow one another in a circle, none of which waits. One behaviour per circle. waits: per behaviour.
[[nodiscard]] std::vector<BehaviourId> timeless_cycles(const Subsystem& subsystem,
                                                       const Numbered<BehaviourId, bool>& waits);

}  // namespace tessera::spec
