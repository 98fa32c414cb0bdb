#pragma once

#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// Reads the section `limits` of an effector: BUFFER[.FIELD...]: { min, max, per_second, beyond }.
/// Either entry may be null.
///
/// safe:   the section `safe`; its numbers, or zero, must lie within the limits.
/// Errors: E101 unknown buffer or field; E103 a limit that limits nothing; E104 form; E107 a buffer that
///         is limited twice; E205 no number; E208 another unit; E211 no numbers in the buffer, min above
///         max, a safe command outside.
[[nodiscard]] std::vector<Limit> read_limits(const Entry* limits, const Entry* safe,
                                             const std::vector<Field>& real, const Types& types,
                                             Diagnostics& out);

}  // namespace tessera::spec
