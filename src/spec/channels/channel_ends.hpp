#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "spec/agents/paths.hpp"

namespace tessera::spec {

/// One end of a channel as written: the subsystem, the buffer, and which agents.
struct WrittenEnd {
  BufferPath path;
  PathTarget target;
  BufferId buffer;                    ///< of a family: the first
  std::optional<Member> family = {};  ///< the buffer is one for each member of that fleet
};

/// One end of one channel: the number of the agent in its group, and the buffer.
struct ExpandedEnd {
  std::uint32_t agent = 0;
  BufferId buffer;

  auto operator<=>(const ExpandedEnd&) const = default;
};

/// The ends that the channels join, from and to.
struct ChannelExpansion {
  std::vector<std::pair<ExpandedEnd, ExpandedEnd>> pairs;
  std::vector<ExpandedEnd> dropped;  ///< those that would receive if the fleet did not end
};

/// Errors: E293 i over fleets of different sizes, one of which has a buffer for each member; E307 `*` at both ends or
///         beside i; i over fleets of different sizes.
[[nodiscard]] bool expand_channel(const WrittenEnd& from, const WrittenEnd& to, ChannelExpansion& into,
                                  Diagnostics& out);

}  // namespace tessera::spec
