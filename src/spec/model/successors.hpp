#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// The behaviours and groups that may begin next, judging only by `next`: after the end of a behaviour; or in a group,
/// as which it begins. A behaviour by which a group is left leads where the group's `next` leads.
[[nodiscard]] std::vector<BehaviourId> successors(const Subsystem& subsystem, BehaviourId of);

}  // namespace tessera::spec
