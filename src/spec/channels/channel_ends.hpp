#pragma once

#include <utility>
#include <vector>

#include "spec/agents/paths.hpp"

namespace tessera::spec {

/// One end of a channel as written: the subsystem, the buffer, and which agents.
struct WrittenEnd {
  BufferPath path;
  PathTarget target;
  BufferId buffer;
};

/// The agents that a channel joins: (number of the one it comes from, number of the one it leads to).
struct ChannelExpansion {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<std::uint32_t> dropped;  ///< numbers of the agents that would receive if the fleet did not end
};

/// Errors: E307 `*` at both ends or beside i; i over fleets of different sizes.
[[nodiscard]] bool expand_channel(const WrittenEnd& from, const WrittenEnd& to, ChannelExpansion& into,
                                  Diagnostics& out);

}  // namespace tessera::spec
