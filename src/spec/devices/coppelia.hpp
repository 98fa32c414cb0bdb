#pragma once

#include "spec/document/document.hpp"
#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads `simulation: coppelia`: { host: NAME, port: NUMBER, scene: FILE, timeout: DURATION }, each of which
/// may be absent.
///
/// Errors: E102, E104, E204, E205, E206 wrong keys and values.
[[nodiscard]] CoppeliaServer read_coppelia(const Entry& entry, Diagnostics& out);

/// Keys of a MuJoCo world have no meaning beside `coppelia`.
///
/// Errors: E107 a second world; E102 the keys track, models, checks and measures.
void refuse_beside_coppelia(const Section& simulation, Diagnostics& out);

}  // namespace tessera::spec
