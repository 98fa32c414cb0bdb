#pragma once

#include <vector>

#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// The sides of channels that subsystems use again and again.
///
/// Linear in the structure: from each behaviour one may follow that uses a side if and only if every set of
/// behaviours that a subsystem cannot leave any more has one that uses it.
class RecurringUses {
 public:
  explicit RecurringUses(const CommunicationStructure& structure);

  /// From each behaviour of the subsystem at that side, may one follow (it itself again included) that uses
  /// this side of the channel? Precondition: some behaviour uses the side.
  [[nodiscard]] bool always(ChannelFlowId channel, Side side) const { return of(side)[channel.value]; }
  /// Can that subsystem, as long as it goes on, come back to this side from wherever it is? It cannot end.
  [[nodiscard]] bool comes_back(ChannelFlowId channel, Side side) const {
    const ChannelFlow& flow = structure_[channel];
    return stays_[(side == Side::send ? flow.sender : flow.receiver).value] && always(channel, side);
  }

 private:
  [[nodiscard]] const std::vector<bool>& of(Side side) const {
    return side == Side::send ? sends_ : receives_;
  }
  void judge(SubsystemFlowId subsystem);

  const CommunicationStructure& structure_;
  std::vector<bool> sends_, receives_;  // per channel
  std::vector<bool> stays_;             // per subsystem: no behaviour of it may end it, or leave it lost
};

}  // namespace tessera::verify
