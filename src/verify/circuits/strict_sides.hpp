#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// A side of a channel between processes that waits for the other as long as it takes.
struct StrictSide {
  SubsystemFlowId subsystem;
  ChannelFlowId channel;
  Side side = Side::receive;
};

/// Those that some reachable behaviour uses. A cut link stops each of them for ever: values that are not
/// needed before may arrive as late as one likes, so its subsystem comes to it with nothing there, or is stuck
/// before. Without any, a cut link stops nobody, since every other side of a network goes on without its peer.
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
