#pragma once

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads the section `script` of the simulation: inputs of operators at certain times of a simulated run,
/// [{ at: 3 s, set: office.console.panel.pause, to: true }]. Adds each to the panel of its driver.
/// entry may be null.
///
/// Errors: E101 unknown agents, subsystems, buffers and controls; E102-E104 keys and forms; E112 paths;
///         E205, E206 times and numbers; E281 no panel; E282 a value that does not fit its control;
///         E283 times that go backwards.
void read_script(const Entry* entry, const Model& model, const AgentGroups& groups,
                 std::vector<Driver>& drivers, Diagnostics& out);

}  // namespace tessera::spec
