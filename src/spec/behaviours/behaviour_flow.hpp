#pragma once

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Checks how the behaviours of one subsystem follow one another.
///
/// Warnings: W311 unreachable behaviour; W312 no entry of `next` may hold after a terminal ending; W313 an
///           error nobody routes; W314 an entry that is never taken; W315 `next` of a behaviour that never ends
///           as terminal; W323 a terminal condition that is never asked.
void check_behaviour_flow(const Subsystem& subsystem, diagnostics::Diagnostics& out);

}  // namespace tessera::spec
