#pragma once

#include <span>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// Is there an order of all recorded firings, with firings of the media in between, that the net allows? All
/// orders are tried. The recordings are whole, one per process, and only their names are believed: nothing of
/// the check that is tested is used.
///
/// Precondition: short recordings.
[[nodiscard]] bool naive_joint(std::span<const Recording> recordings, const net::Net& net);

}  // namespace tessera::replay
