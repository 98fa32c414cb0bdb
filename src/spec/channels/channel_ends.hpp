#pragma once

#include <utility>
#include <vector>

#include "spec/agents/paths.hpp"

namespace tessera::spec {

/// One end of a channel as written: the subsystem, the buffer, and which agents.
struct End {
  BufferPath path;
  Place place;
  Index buffer = none;
};

/// The pairs of agents that a channel joins: (number of the sender, number of the receiver).
struct Expansion {
  std::vector<std::pair<Index, Index>> pairs;
  std::vector<Index> dropped;  ///< numbers of the agents that would receive if the fleet did not end
};

/// Errors: E307 `*` at both ends or beside i; i over fleets of different sizes.
[[nodiscard]] bool expand(const End& from, const End& to, Expansion& into, Diagnostics& out);

}  // namespace tessera::spec
