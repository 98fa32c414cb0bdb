#pragma once

#include "diagnostics/diagnostics.hpp"
#include "spec/model.hpp"

namespace tessera::spec {

/// Looks at how the behaviours of one subsystem follow one another.
///
/// Warnings: W311 unreachable behaviour; W312 no unconditional last `next`; W313 an error nobody routes; W314
/// an entry
///           behind an unconditional one; W315 `next` of a behaviour that never ends.
void check_flow(const Subsystem& subsystem, diagnostics::Diagnostics& out);

}  // namespace tessera::spec
