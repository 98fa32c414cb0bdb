#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// A run with the same end that is easier to follow. It is as short as a search of limited cost finds, and
/// the firings of a subsystem follow each other as far as their causal order allows. For runs that show
/// something by the marking they end in.
///
/// net: every place holds at most one token. A run that puts two into one place is returned unchanged.
/// Threads: pure. Deterministic.
[[nodiscard]] std::vector<net::TransitionId> tidy(const net::Net& net, std::vector<net::TransitionId> run);

}  // namespace tessera::verify
