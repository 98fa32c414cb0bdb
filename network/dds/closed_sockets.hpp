#pragma once

#include <set>

#include "network/dds/location.hpp"

namespace tessera::dds {

/// The open file descriptors of this process.
[[nodiscard]] std::set<int> open_files();

/// Lets the sockets that the middleware has opened receive only from the interface of `location` and from
/// loopback. Cyclone DDS binds them to all addresses of the host, whatever its configuration says.
///
/// before: the files that were open before the middleware opened its sockets.
/// Errors: SetupError: the kernel refuses, or there is no such socket.
void close_sockets_to_other_interfaces(const std::set<int>& before, int domain, const Location& location);

}  // namespace tessera::dds
