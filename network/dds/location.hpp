#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "network/dds/peer_search.hpp"

namespace tessera::dds {

/// The address of a process in the network, and the addresses where it looks for others.
struct Location {
  unsigned interface_index = 0;  ///< as the kernel numbers interfaces
  bool is_loopback = false;
  std::string address;             ///< of this process: "127.0.0.1"
  std::vector<std::string> peers;  ///< addresses, this host's own first
  struct Unresolved {
    std::string host, why;
  };
  std::vector<Unresolved> unresolved;  ///< peers that have no address now
  [[nodiscard]] std::vector<std::string> unresolved_hosts() const;
};

/// Asks the name service of this machine. See AddressOf.
[[nodiscard]] std::optional<std::string> resolve(const std::string& host, std::string& why);

/// false: it was there already, or is this host. Errors: SetupError: the interface does not reach it.
bool add_peer(Location& location, std::string_view host, const std::string& address);

/// interface: a name ("wlan0") or an IPv4 address of one; empty: loopback. peers: host names or addresses.
///
/// Errors: SetupError if there is no such interface, it has no IPv4 address, or the peers cannot be reached over
/// it. It waits for the answer of the name service.
[[nodiscard]] Location locate(std::string_view interface, std::span<const std::string_view> peers,
                              const AddressOf& address_of = resolve);

}  // namespace tessera::dds
