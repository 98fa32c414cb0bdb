#pragma once

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// Reads the section `safe` of an effector into the subsystem: BUFFER: VALUE. entry may be null. Numbers may be
/// `.nan` and `.inf` where the subsystem allows them, so its policies and limits are read before.
///
/// Errors:   E101 unknown buffer or field; E203, E204, E208 values that do not fit; E216 a number that must be
///           finite.
/// Warnings: W340 numbers that may be NaN and that the safe command does not mention, so that they are zero.
void read_safe(const Entry* entry, const Types& types, Subsystem& subsystem, Diagnostics& out);

}  // namespace tessera::spec
