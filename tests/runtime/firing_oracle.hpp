#pragma once

#include <string>

#include "tessera/recording.hpp"
#include "tessera/tables.hpp"

namespace tessera::testing {

/// Plays a recording on the flat net of the system, one token at a time, without the firing code of the
/// runtime. Events of one instance stay in order, and so do events of one channel (by version). Any other
/// order is allowed, except for a simulated run, which has the order of the file. Empty: a legal firing
/// sequence; otherwise the illegal event.
///
/// It does not use tests/oracle/nets: it plays one recorded run and no graph, every second token is an error,
/// and an event must carry the next version of its channel.
[[nodiscard]] std::string complaint_about(const Recording& recording, const System& system);

}  // namespace tessera::testing
