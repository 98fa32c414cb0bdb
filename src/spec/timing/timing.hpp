#pragma once

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the section `timing`. entry may be null. The channels of the model must be there.
///
/// Errors: E101 unknown agents, subsystems and buffers; E102 to E107 forms and names; E112, E303 indices; E205, E206
///         times; E304 a real buffer in a path; E307 fleets of different sizes; E381 a path that does not connect;
///         E382 a path that does not lead from a receptor to an effector; E387, E388 a foreign node at another
///         place than between an effector and a receptor.
/// Warns:  W344 a network that no channel crosses.
[[nodiscard]] Timing read_timing(const Entry* entry, const Model& model, const AgentGroups& groups,
                                 Diagnostics& out);

}  // namespace tessera::spec
