#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::dds {

/// Where in the network a process is, and where it looks for others.
struct Location {
  unsigned interface_index = 0;  ///< as the kernel numbers interfaces
  bool is_loopback = false;
  std::string address;             ///< of this process: "127.0.0.1"
  std::vector<std::string> peers;  ///< addresses, this host's own first
};

/// interface: a name ("wlan0") or an IPv4 address of one; empty: loopback. peers: host names or addresses.
///
/// Errors: SetupError if there is no such interface, it has no IPv4 address, a peer has none, or the peers cannot
/// be reached over it. It waits for the answer of the name service.
[[nodiscard]] Location locate(std::string_view interface, std::span<const std::string_view> peers);

}  // namespace tessera::dds
