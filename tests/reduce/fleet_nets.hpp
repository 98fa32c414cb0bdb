#pragma once

#include <vector>

#include "fleet/fleet.hpp"
#include "net/net.hpp"

namespace tessera::test {

/// The flat net of a fleet's specification. Throws if it is refused.
[[nodiscard]] net::Net fleet_net(const Fleet& fleet);

/// The transitions of each subsystem.
[[nodiscard]] std::vector<std::vector<net::TransitionId>> per_subsystem(const net::Net& net);

}  // namespace tessera::test
