#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// The run, with the ending (t5 or t6) of each behaviour that fits the entry of `next` after it.
///
/// t5 and t6 of a behaviour lead to the same place, so a run of the abstract net may end a behaviour by t5
/// and go on with an entry of `next` that is taken only after an error, or the other way round. No controller
/// does that. With the other ending, the run is the same in everything else. So with groups: the entry by which one
/// is left, and the ending before it, fit the entry that is taken behind the group.
///
/// Precondition: the run is one of the net, an abstract net. Linear. Threads: pure.
[[nodiscard]] std::vector<net::TransitionId> with_fitting_endings(const net::Net& net,
                                                                  std::vector<net::TransitionId> run);

}  // namespace tessera::verify
