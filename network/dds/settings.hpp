#pragma once

#include <chrono>
#include <string>

#include "network/dds/location.hpp"

namespace tessera::dds {

/// The largest number of processes that can find each other on one host.
inline constexpr int most_processes_on_a_host = 80;

/// The first UDP port of a domain for unicast, and the number of ports that follow it.
[[nodiscard]] int first_port(int domain);
inline constexpr int ports_of_a_host = 2 * most_processes_on_a_host + 2;

/// After so long a silence the others forget a process. A shorter interruption of the network has no effect
/// on discovery.
inline constexpr std::chrono::seconds usual_lease{20};

/// The configuration of Cyclone DDS: only this interface, no multicast, only these peers. It ignores the
/// environment (CYCLONEDDS_URI).
///
/// Errors: SetupError: there is no such domain.
[[nodiscard]] std::string settings(int domain, const Location& location,
                                   std::chrono::seconds lease = usual_lease);

}  // namespace tessera::dds
