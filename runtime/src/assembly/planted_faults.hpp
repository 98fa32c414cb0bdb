#pragma once

#include <string>

#include "subsystem/injection.hpp"
#include "subsystem/subsystem_parts.hpp"
#include "system/clock.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// Reads the faults of `--inject`.
///
/// Errors: as read_injection: false and `error`.
[[nodiscard]] bool read_faults(const RunOptions& options, const System& system, Injections& faults,
                               std::string& error);

/// Plants the faults of the transition functions. Precondition: the subsystem is made and not bound yet.
void plant_subsystem_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock);

/// Plants the faults of the devices. Precondition: receptors and effectors are made and not opened yet.
void plant_device_faults(SubsystemParts& parts, const Injections& faults, const Clock& clock);

}  // namespace tessera
