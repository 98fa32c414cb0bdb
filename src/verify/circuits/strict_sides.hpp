#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// A side of a channel between processes that waits for the other side without a limit.
struct StrictSide {
  SubsystemFlowId subsystem;
  ChannelFlowId channel;
  Side side = Side::receive;
};

/// Those that some reachable behaviour uses. A cut link stops each of them for ever: values that are not
/// needed earlier may arrive at any later time, so the subsystem comes to this side without a value, or is
/// stuck before. If there is no such side, a cut link stops no subsystem, since every other side of a network
/// goes on without its peer.
///
/// Linear in the structure. docs/use/fleets.md says why.
[[nodiscard]] std::vector<StrictSide> strict_sides(const CommunicationStructure& structure);

/// "robot.control waits for values of a.y->b.x from base.control, and 2 more sides wait so"
[[nodiscard]] std::string in_words(const CommunicationStructure& structure,
                                   const std::vector<StrictSide>& sides);

/// "give a timeout to ...", with the lines of the specification.
[[nodiscard]] std::string timeout_hint(const CommunicationStructure& structure, const net::Net& net,
                                       const std::vector<StrictSide>& sides);

}  // namespace tessera::verify
