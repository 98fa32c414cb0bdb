#include "network/dds/location.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "network/dds/setup_error.hpp"

namespace tessera::dds {
namespace {

std::string text_of(const in_addr& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

const in_addr& address_in(const sockaddr* address) {
  return reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
}

struct InterfaceList {
  InterfaceList() {
    if (getifaddrs(&first) != 0) throw SetupError("the interfaces of this machine cannot be listed");
  }
  ~InterfaceList() { freeifaddrs(first); }
  InterfaceList(const InterfaceList&) = delete;
  InterfaceList& operator=(const InterfaceList&) = delete;
  ifaddrs* first = nullptr;
};

Location find_interface(const std::string& wanted) {
  const InterfaceList list;
  std::string known;
  for (const ifaddrs* one = list.first; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const std::string address = text_of(address_in(one->ifa_addr));
    if (wanted == one->ifa_name || wanted == address) {
      if ((one->ifa_flags & IFF_UP) == 0) throw SetupError("interface " + wanted + " is down");
      return {.interface_index = if_nametoindex(one->ifa_name),
              .is_loopback = (one->ifa_flags & IFF_LOOPBACK) != 0,
              .address = address,
              .peers = {},
              .unresolved = {}};
    }
    known += (known.empty() ? "" : ", ") + std::string(one->ifa_name) + " (" + address + ")";
  }
  throw SetupError("there is no interface " + wanted + " with an IPv4 address; there are " + known);
}

}  // namespace

std::vector<std::string> Location::unresolved_hosts() const {
  std::vector<std::string> hosts;
  for (const Unresolved& one : unresolved) hosts.push_back(one.host);
  return hosts;
}

std::optional<std::string> resolve(const std::string& host, std::string& why) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (failure != 0) {
    why = gai_strerror(failure);
    return std::nullopt;
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  return text_of(address_in(found->ai_addr));
}

bool add_peer(Location& location, std::string_view host, const std::string& address) {
  if (address.starts_with("127.")) return false;
  if (location.is_loopback)
    throw SetupError("peer " + std::string(host) + " (" + address +
                     ") is on another host: name the interface that leads there");
  if (std::ranges::find(location.peers, address) != location.peers.end()) return false;
  location.peers.push_back(address);
  return true;
}

Location locate(std::string_view interface, std::span<const std::string_view> peers,
                const AddressOf& address_of) {
  Location location = find_interface(interface.empty() ? "lo" : std::string(interface));
  if (!location.is_loopback && peers.empty())
    throw SetupError("interface " + std::string(interface) +
                     " needs peers: the hosts of the other processes (there is no multicast)");
  location.peers.push_back(location.address);
  for (const std::string_view peer : peers) {
    std::string why;
    if (const auto address = address_of(std::string(peer), why))
      add_peer(location, peer, *address);
    else
      location.unresolved.push_back({std::string(peer), why});
  }
  return location;
}

}  // namespace tessera::dds
