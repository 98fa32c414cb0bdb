#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// After the run, none of the stuck transitions can ever fire again. Returns the firings that cause this:
/// they are a run by themselves, and after it still none of the transitions can fire. Both are checked; if
/// they cannot be shown, the run is returned unchanged.
///
/// Firings of other subsystems are removed, unless the transitions wait for these subsystems.
/// Linear in the net and the run, times the subsystems that have to do with it. Threads: pure.
[[nodiscard]] std::vector<net::TransitionId> causes_of_standstill(
    const net::Net& net, std::vector<net::TransitionId> run, const std::vector<net::TransitionId>& stuck);

/// Can it be shown that none of the transitions can ever be fired after the run? It is shown if they could
/// not fire even if firing consumed no tokens.
[[nodiscard]] bool never_again(const net::Net& net, const std::vector<net::TransitionId>& run,
                               const std::vector<net::TransitionId>& transitions);

/// Extends the run until the subsystems that the stuck transitions wait for wait too, and so on. Its end then
/// shows the cycle of waits, or a subsystem that has ended. Returns the run unchanged if some of them would
/// run for ever.
[[nodiscard]] std::vector<net::TransitionId> until_all_concerned_wait(
    const net::Net& net, std::vector<net::TransitionId> run, const std::vector<net::TransitionId>& stuck);

}  // namespace tessera::verify
