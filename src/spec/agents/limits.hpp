#pragma once

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// Reads the section `limits` of an effector, BUFFER[.FIELD...]: { min, max, per_second, beyond, non_finite },
/// into `limits` and `non_finite` of the subsystem. Either entry may be null.
///
/// safe:   the section `safe`; its numbers, or zero, must lie within the limits.
/// Errors: E101 unknown buffer or field; E103 a limit that limits nothing; E104 form; E107 a buffer that
///         is limited twice; E205 no number; E208 another unit; E211 no numbers in the buffer, min above
///         max, a safe command outside.
void read_limits(const Entry* limits, const Entry* safe, const Types& types, Subsystem& subsystem,
                 Diagnostics& out);

}  // namespace tessera::spec
