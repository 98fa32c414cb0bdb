#pragma once

#include <span>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// Whether the net allows some order of all recorded firings, with firings of the media in between. It tries
/// all orders. The recordings are whole, one per process, and it relies only on their names: it uses no part
/// of the tested check.
///
/// Precondition: short recordings.
[[nodiscard]] bool naive_legality(std::span<const Recording> recordings, const net::Net& net);

}  // namespace tessera::replay
