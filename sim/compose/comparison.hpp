#pragma once

#include <string>
#include <vector>

#include "sim/compose/compose.hpp"

namespace tessera::sim {

/// The differences between an instance in a composed world and its model file compiled alone: masses,
/// inertias, frames, joints, geoms, sites, cameras, actuators, tendons, equalities, sensors. Numbers are
/// equal up to 1e-12, relative to the larger one above 1. At most ten are listed, each as "mass of body
/// 'hull': 3, not 2".
[[nodiscard]] std::vector<std::string> differences(const mjModel& composed, const PlacedModel& placed);

}  // namespace tessera::sim
