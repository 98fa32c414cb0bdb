#pragma once

#include <sys/types.h>

#include <map>

#include "network/dds/location.hpp"

namespace tessera::dds {

/// The open sockets of this process, by their inode numbers. A descriptor that another thread closes is taken again
/// by the next socket, so that it does not tell whether a socket was open before; its inode number does.
using OpenSockets = std::map<ino_t, int>;  // values: file descriptors
/// Errors: SetupError: /proc/self/fd cannot be read. Any thread.
[[nodiscard]] OpenSockets open_sockets();

/// Lets the sockets that the middleware has opened receive only from the interface of `location` and from
/// loopback. Cyclone DDS binds them to all addresses of the host, whatever its configuration says.
///
/// before: the sockets that were open before the middleware opened its own.
/// Errors: SetupError: the kernel refuses, or there is no such socket.
void close_sockets_to_other_interfaces(const OpenSockets& before, int domain, const Location& location);

}  // namespace tessera::dds
