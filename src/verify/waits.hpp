#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// Who can fire nothing in the marking that a run leads to, and for whom it waits: "a.control waits for a
/// value of b.control.y->a.control.x from b.control".
///
/// only: indices of subsystems; then just these, those they wait for, and so on. Empty: all.
/// Precondition: the run is one of the net.
[[nodiscard]] std::vector<std::string> waits_after(const net::Net& net,
                                                   const std::vector<net::TransitionId>& run,
                                                   const std::vector<std::uint32_t>& only = {});

/// The path of each subsystem, by its number: "robot.control".
[[nodiscard]] std::vector<std::string> subsystem_names(const net::Net& net);

}  // namespace tessera::verify
