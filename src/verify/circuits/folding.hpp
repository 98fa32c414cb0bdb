#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// Does this side wait for the other without a limit?
[[nodiscard]] bool waits_to_send(const ChannelFlow& channel);
[[nodiscard]] bool waits_to_receive(const ChannelFlow& channel);
/// May one side have to wait for the other without a limit? If not, no subsystem can get stuck
/// at the channel.
[[nodiscard]] bool holds_up(const ChannelFlow& channel);

/// A subsystem as one cyclic sequence of communications, those on channels that holds_up() names.
struct Folded {
  std::string why_not;       ///< why it is no such sequence; empty: it is one
  std::vector<Stage> cycle;  ///< stages of parallel blocks are sorted by channel
  /// Channels to which a start-up sends before the first round, without waiting.
  std::vector<ChannelFlowId> primed;
  bool can_end = false;
};

/// Folds the behaviours of a subsystem: behaviours that use the same channels in the same order become one, and
/// behaviours that follow each other in one fixed cycle become one longer round. A
/// start-up consists of behaviours that run once, in a fixed order, before the rest; it may differ if it does
/// not wait for another subsystem.
///
/// Linear in the subsystem for a given number of behaviours.
[[nodiscard]] Folded fold(const SubsystemFlow& subsystem, const CommunicationStructure& structure);

}  // namespace tessera::verify
