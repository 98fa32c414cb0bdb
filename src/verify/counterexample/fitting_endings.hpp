#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// The run with the endings that fit what follows them.
///
/// t5 and t6 of a behaviour lead to the same place, so a run of the abstract net may end a behaviour by t5
/// and go on with an entry of `next` that is taken only after an error, or the other way round. No controller
/// does that; with the other of the two it is the same run in all else.
///
/// Precondition: the run is one of the net, an abstract net. Linear. Threads: pure.
[[nodiscard]] std::vector<net::TransitionId> with_fitting_endings(const net::Net& net,
                                                                  std::vector<net::TransitionId> run);

}  // namespace tessera::verify
