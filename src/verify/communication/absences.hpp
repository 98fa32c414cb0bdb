#pragma once

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// Sets ChannelFlow::absent and ChannelFlow::absence of each channel one of whose ends no reachable behaviour
/// uses. net: the one of the structure.
///
/// Linear in the net.
void name_absences(CommunicationStructure& structure, const net::Net& net);

}  // namespace tessera::verify
