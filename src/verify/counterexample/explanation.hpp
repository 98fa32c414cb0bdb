#pragma once

#include <vector>

#include "explore/budget.hpp"
#include "net/net.hpp"
#include "verify/subsystem_at_end.hpp"

/// The end of a run to a violation, and the waits there. Only waits that last for ever are named.
namespace tessera::verify {

struct Explanation {
  std::vector<net::TransitionId> run;
  std::vector<SubsystemAtEnd> waits;
};

/// Extends a run after which the property "one of these transitions can always be fired again" can no longer
/// be true. The extended run ends where
///
/// * none of the transitions can ever be fired again, and
/// * each subsystem that is waited for is stuck for ever too, has ended, or can go on without giving the
///   missing token.
///
/// stuck: transitions of one subsystem. The cost is limited by steps: the same end on every machine. Throws
/// explore::CutOff if the budget is spent before. If there are too many markings to see all that may follow, the run is
/// extended as far as possible, and only subsystems that can be shown to be stuck are named.
[[nodiscard]] Explanation explained(const net::Net& net, std::vector<net::TransitionId> run,
                                    const std::vector<net::TransitionId>& stuck,
                                    const explore::Budget& budget = explore::Budget(explore::Limits{}));

/// Extends a run after which a violation is final: nothing that follows can undo it. The extended run ends
/// where each subsystem that a stuck one waits for is stuck for ever too, has ended, or can go on without
/// giving the missing token. If there are too many markings to see all that may follow, the run is unchanged.
/// Budget: as above.
[[nodiscard]] Explanation explained(const net::Net& net, std::vector<net::TransitionId> run,
                                    const explore::Budget& budget = explore::Budget(explore::Limits{}));

}  // namespace tessera::verify
