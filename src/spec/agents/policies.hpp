#pragma once

#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads how a subsystem treats time and faults: overrun, receive, watchdog, recovery, non_finite, realtime.
///
/// Errors: E104 none of the choices; E110 `overrun` without a rate, `receive` without inputs; E204 a priority
///         outside 1 .. 99, a cpu outside 0 .. 1023, or one that is no number; E205, E206 durations.
void read_policies(const Section& section, Subsystem& subsystem, Diagnostics& out);

}  // namespace tessera::spec
