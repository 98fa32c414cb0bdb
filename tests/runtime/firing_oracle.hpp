#pragma once

#include <string>

#include "tessera/recording.hpp"
#include "tessera/tables.hpp"

namespace tessera::testing {

/// Plays a recording on the flat net of the system, one token at a time, knowing nothing of the runtime's
/// firing. Events of one instance stay in order, and so do events of one channel (by version); otherwise any
/// order will do, except that of a simulated run, which is that of the file. Empty: a legal firing sequence;
/// otherwise what is illegal.
///
/// It does not use tests/oracle/nets: it plays one recorded run and no graph, every second token is an error,
/// and an event must carry the next version of its channel.
[[nodiscard]] std::string complaint_about(const Recording& recording, const System& system);

}  // namespace tessera::testing
