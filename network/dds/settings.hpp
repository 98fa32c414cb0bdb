#pragma once

#include <string>

#include "network/dds/location.hpp"

namespace tessera::dds {

/// How many processes can be found on one host.
inline constexpr int most_processes_on_a_host = 80;

/// The first UDP port of a domain for unicast, and how many follow it.
[[nodiscard]] int first_port(int domain);
inline constexpr int ports_of_a_host = 2 * most_processes_on_a_host + 2;

/// The configuration of Cyclone DDS: only this interface, no multicast, only these peers. The environment
/// (CYCLONEDDS_URI) has no part in it.
///
/// Errors: SetupError: no such domain.
[[nodiscard]] std::string settings(int domain, const Location& location);

}  // namespace tessera::dds
