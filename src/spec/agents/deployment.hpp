#pragma once

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads `deploy` into model.deployment and the process of every agent. The entry may be null: then there is
/// no deployment.
///
/// Errors: E101 unknown agent; E103 no processes; E104-E107 forms and names; E112, E303 indices; E206 domain;
///         E307 fleets of different sizes; E315 an agent in two processes or in none; E316 a channel between
///         processes that has a communication model of the author.
void read_deployment(const Entry* entry, const AgentGroups& groups, Model& model, Diagnostics& out);

}  // namespace tessera::spec
