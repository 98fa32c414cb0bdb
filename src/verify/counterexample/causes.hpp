#pragma once

#include <vector>

#include "explore/budget.hpp"
#include "net/net.hpp"

namespace tessera::verify {

/// After the run, none of the stuck transitions can ever fire again. Returns the firings that cause this:
/// they are a run by themselves, and after it still none of the transitions can fire. Both are checked; if
/// they cannot be shown, the run is returned unchanged.
///
/// Firings of other subsystems are removed, unless the transitions wait for these subsystems.
/// Linear in the net and the run, times the subsystems that have to do with it. Throws explore::CutOff if
/// the budget is spent before. Threads: pure.
[[nodiscard]] std::vector<net::TransitionId> causes_of_standstill(const net::Net& net,
                                                                  std::vector<net::TransitionId> run,
                                                                  const std::vector<net::TransitionId>& stuck,
                                                                  const explore::Budget& budget);

/// The firings of the run behind the tokens that these places hold in the end. They are a run by themselves,
/// after which the places hold the same tokens; others may hold fewer. Linear.
[[nodiscard]] std::vector<net::TransitionId> causes_of_tokens(const net::Net& net,
                                                              std::vector<net::TransitionId> run,
                                                              const std::vector<net::PlaceId>& places);

/// The transitions that could fire at some time after the run if firing consumed no tokens. The others can
/// never be fired again. Linear.
[[nodiscard]] std::vector<bool> possible_after(const net::Net& net,
                                               const std::vector<net::TransitionId>& run);

/// Can it be shown, by possible_after, that none of the transitions can ever be fired after the run?
[[nodiscard]] bool never_again(const net::Net& net, const std::vector<net::TransitionId>& run,
                               const std::vector<net::TransitionId>& transitions);

/// Extends the run until the subsystems that the stuck transitions wait for wait too, and so on. Its end then
/// shows the cycle of waits, or a subsystem that has ended. Returns the run unchanged if some of them would
/// run for ever. Throws explore::CutOff if the budget is spent before.
[[nodiscard]] std::vector<net::TransitionId> until_all_concerned_wait(
    const net::Net& net, std::vector<net::TransitionId> run, const std::vector<net::TransitionId>& stuck,
    const explore::Budget& budget);

}  // namespace tessera::verify
