#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// Behaviours that a run could go round in for ever without time passing: those that repeat, or follow one
/// another in a circle, none of them waiting. One behaviour per circle. waits: per behaviour.
[[nodiscard]] std::vector<BehaviourId> timeless_cycles(const Subsystem& subsystem,
                                                       const Numbered<BehaviourId, bool>& waits);

}  // namespace tessera::spec
