#pragma once

#include <vector>

#include "replay/deployed_net.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// Does a process die in this recording of a simulated run?
[[nodiscard]] bool has_deaths(const Recording& run);

/// Takes the recording of a simulated run of a whole system apart: one recording per start of each process,
/// as if
/// each had recorded itself. The transitions of the system are in none. A start that dies is not cut off:
/// all that
/// it did until then is there.
///
/// Precondition: the transitions of the recording are those of the net.
[[nodiscard]] std::vector<Recording> recordings_of_starts(const Recording& run, const DeployedNet& net,
                                                          const ProcessMap& processes);

}  // namespace tessera::replay
