#pragma once

#include <cstdint>
#include <string>

#include "tessera/time.hpp"

namespace tessera::coppelia {

/// The numeric address ("127.0.0.1", "::1") at which a program listens at this port of the host.
///
/// ZeroMQ connects in the background and never reports a missing server, so this function checks first.
///
/// Errors: LinkError: the host is unknown, cannot be reached, or no program listens.
[[nodiscard]] std::string listening_address(const std::string& host, std::uint16_t port, Duration patience);

}  // namespace tessera::coppelia
