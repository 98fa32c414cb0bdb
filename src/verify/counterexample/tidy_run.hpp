#pragma once

#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// A run with the same end that is easier to follow: as short as a search of limited cost finds, and with the
/// firings of a subsystem side by side, as far as what depends on what allows. Of a run that shows something
/// by where it ends.
///
/// net: in which every place holds at most one token; a run that leads to two is given back as it is.
/// Threads: pure. Deterministic.
[[nodiscard]] std::vector<net::TransitionId> tidy(const net::Net& net, std::vector<net::TransitionId> run);

}  // namespace tessera::verify
