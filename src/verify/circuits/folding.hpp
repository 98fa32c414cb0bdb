#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// Does this side wait for the other for as long as it takes?
[[nodiscard]] bool waits_to_send(const ChannelFlow& channel);
[[nodiscard]] bool waits_to_receive(const ChannelFlow& channel);
/// May one side have to wait for the other? If not, the channel never holds anybody up for long.
[[nodiscard]] bool holds_up(const ChannelFlow& channel);

/// A subsystem as one cyclic sequence of the communications that may hold somebody up.
struct Folded {
  std::string why_not;       ///< empty: it is such a sequence
  std::vector<Stage> cycle;  ///< stages of parallel blocks are sorted by channel
  std::vector<std::uint32_t>
      primed;  ///< channels to which a start-up sends before the first round, without waiting
  bool can_end = false;
};

/// Folds the behaviours of a subsystem: those that use the same channels in the same order are one. A
/// start-up, behaviours that are run once in a fixed order before the rest, may differ if it does not wait
/// for anybody.
///
/// Linear in the subsystem for a given number of behaviours.
[[nodiscard]] Folded fold(const SubsystemFlow& subsystem, const std::vector<ChannelFlow>& channels);

/// From each behaviour, may one follow (it itself again included) that uses this side of the channel?
[[nodiscard]] bool always_uses_again(const SubsystemFlow& subsystem, std::uint32_t channel, Side side);

}  // namespace tessera::verify
