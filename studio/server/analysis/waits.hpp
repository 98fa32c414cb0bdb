#pragma once

#include <cstdint>
#include <vector>

#include "net/net.hpp"
#include "verify/subsystem_at_end.hpp"

namespace tessera::server {

/// The subsystems that cannot fire in a marking and have not ended, and the subsystems that they wait for.
/// They may go on once another subsystem has acted: the result concerns this marking only.
///
/// marked: the places that hold a token; numbers beyond the net's are ignored.
/// Threads: pure. Linear in the net times its subsystems.
[[nodiscard]] std::vector<verify::SubsystemAtEnd> waits_in(const net::Net& net,
                                                           const std::vector<std::uint32_t>& marked);

}  // namespace tessera::server
