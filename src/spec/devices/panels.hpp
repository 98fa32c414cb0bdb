#pragma once

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads { panel: CONTROLS, stale: TIME } for a real buffer of that type. CONTROLS is `true` (one control for
/// each number and each bool), FIELD: CONTROL pairs, or one control if the buffer is no structure. A control
/// is `button`, `switch`, `slider`, `stick_x`, `stick_y`, or a map such as { slider: [0, 0.5 m/s] }.
///
/// Errors: E101 unknown fields and controls; E102, E104 keys and forms; E205, E206 the time; E205, E208 limits
///         of a range; E210 nothing can be operated; E213 a control that does not fit its field.
[[nodiscard]] Panel read_panel(const Entry& entry, const Type& type, const Model& model, Diagnostics& out);

}  // namespace tessera::spec
