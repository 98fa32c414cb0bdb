#pragma once

#include "assembly/assembly.hpp"
#include "watch/monitor_protocol.hpp"

namespace tessera {

/// The present state of a run's subsystems and channels, without its recording and its pace.
///
/// Threads: any.
[[nodiscard]] Snapshot take_snapshot(const Assembly& assembly, const Clock& clock);

}  // namespace tessera
