#pragma once

#include <set>

#include "network/dds/location.hpp"

namespace tessera::dds {

/// The open file descriptors of this process.
[[nodiscard]] std::set<int> open_files();

/// Lets the sockets that the middleware has opened receive from the interface of `location` and from loopback
/// only. Cyclone DDS binds them to all addresses of the host, whatever its configuration says.
///
/// before: what was open before the middleware opened them.
/// Errors: SetupError: the kernel refuses, or there is no such socket.
void close_sockets_to_other_interfaces(const std::set<int>& before, int domain, const Location& location);

}  // namespace tessera::dds
