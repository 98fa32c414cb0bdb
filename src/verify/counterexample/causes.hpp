#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// Of a run after which none of some transitions can ever fire again, the firings that are to blame: without
/// the others it is still a run, and still none of them can fire after it. That is tested on the way; a run
/// of which it cannot be shown is given back as it is.
///
/// What other subsystems did meanwhile goes, unless the transitions wait for them.
/// Linear in the net and the run, times the subsystems that have to do with it. Threads: pure.
[[nodiscard]] std::vector<net::TransitionId> causes_of_standstill(
    const net::Net& net, std::vector<net::TransitionId> run, const std::vector<net::TransitionId>& stuck);

/// Can it be shown that none of the transitions can ever be fired after the run? It is, if they could not
/// even if tokens were never used up.
[[nodiscard]] bool never_again(const net::Net& net, const std::vector<net::TransitionId>& run,
                               const std::vector<net::TransitionId>& transitions);

/// The run, gone on with until those that the stuck transitions wait for wait too, and so on: then it shows
/// the cycle, or who has ended. As it is if some of them would run for ever.
[[nodiscard]] std::vector<net::TransitionId> until_all_concerned_wait(
    const net::Net& net, std::vector<net::TransitionId> run, const std::vector<net::TransitionId>& stuck);

}  // namespace tessera::verify
