#pragma once

#include <optional>
#include <string>
#include <vector>

#include "links/network_conditions.hpp"
#include "nets/process_part.hpp"
#include "subsystem/injection.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "system/clock.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// Reads the faults of `--inject`. Faults of other processes are left out.
///
/// Errors: see read_injection; a cut link under the steady clock: false and `error`.
[[nodiscard]] bool read_faults(const RunOptions& options, const ProcessPart& part, Injections& faults,
                               std::string& error);

/// Returns the fault whose time is not before the end of the run, in words. nullopt: there is none, or the end
/// is not known.
[[nodiscard]] std::optional<std::string> fault_after_end(const Injections& faults, const RunOptions& options);

/// Says which faults have happened in a run that has ended at that time.
[[nodiscard]] std::vector<RunSummary::PlantedFault> happened(const Injections& faults, Time end);

/// The links that are cut.
[[nodiscard]] std::vector<Cut> cuts_of(const Injections& faults);

/// The times at which processes die and begin again, in the order of their deaths. false and `error`: a
/// process dies while it is dead.
[[nodiscard]] bool outages_of(const Injections& faults, const System& whole, std::vector<Outage>& outages,
                              std::string& error);

/// Plants the faults of the transition functions. Precondition: the subsystem is made and not bound yet.
void plant_subsystem_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock);

/// Plants the faults of the devices. Precondition: receptors and effectors are made and not opened yet.
void plant_device_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock);

}  // namespace tessera
