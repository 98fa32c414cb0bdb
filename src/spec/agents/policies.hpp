#pragma once

#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// What a subsystem does about time and faults: `overrun`, `watchdog`, `recovery`, `non_finite`, `realtime`.
///
/// Errors: E104 not among the choices; E110 `overrun` without a rate; E204 a priority outside 1 .. 99, a cpu
/// outside 0 .. 1023, or neither a number; E205, E206 of durations.
void read_policies(const Section& section, Subsystem& subsystem, Diagnostics& out);

}  // namespace tessera::spec
