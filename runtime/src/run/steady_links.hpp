#pragma once

#include <atomic>

#include "assembly/assembly.hpp"
#include "system/clock.hpp"

namespace tessera {

/// Serves the links until the run is to stop. If it stops because the net has ended, it goes on for a while:
/// other processes may still need values that were sent, and acknowledgements.
///
/// Threads: that of the network.
void serve_links_until_end(Assembly& assembly, const SteadyClock& clock, const std::atomic<bool>& net_ended);

/// Whether some subsystem waits for another process, whose state is not known here. Threads: any.
[[nodiscard]] bool waits_for_network(const Assembly& assembly);

}  // namespace tessera
