#pragma once

#include <vector>

#include "explore/budget.hpp"
#include "net/net.hpp"

namespace tessera::verify {

/// A run with the same end that is easier to follow. It is as short as a search of limited cost finds, and
/// the firings of a subsystem follow each other as far as their causal order allows. For runs that show
/// something by the marking they end in.
///
/// net: every place holds at most one token. A run that puts two into one place is returned unchanged.
/// The cost is limited by steps: the same run on every machine. Throws explore::CutOff if the budget is
/// spent before.
/// Threads: pure. Deterministic.
[[nodiscard]] std::vector<net::TransitionId> tidy(
    const net::Net& net, std::vector<net::TransitionId> run,
    const explore::Budget& budget = explore::Budget(explore::Limits{}));

}  // namespace tessera::verify
