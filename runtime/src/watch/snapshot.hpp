#pragma once

#include <optional>

#include "assembly/assembly.hpp"
#include "tessera/control_messages.hpp"

namespace tessera {

/// The present state of a run's subsystems and channels, without its recording and its pace.
///
/// Threads: any.
[[nodiscard]] Snapshot take_snapshot(const Assembly& assembly, const Clock& clock);

/// The network on which the processes of the system meet, as this run was told; nullopt: it has none.
///
/// Threads: any.
[[nodiscard]] std::optional<Snapshot::Deployment> deployment_of(const Assembly& assembly);

}  // namespace tessera
