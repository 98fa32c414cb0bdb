#pragma once

#include "assembly/assembly.hpp"
#include "watch/monitor_protocol.hpp"

namespace tessera {

/// What the subsystems and channels of a run show by now, without its recording and its pace.
///
/// Threads: any.
[[nodiscard]] Snapshot take_snapshot(const Assembly& assembly, const Clock& clock);

}  // namespace tessera
