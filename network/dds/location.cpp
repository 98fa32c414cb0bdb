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

bool is_loopback(const in_addr& address) { return (ntohl(address.s_addr) >> 24) == 127; }

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
              .peers = {}};
    }
    known += (known.empty() ? "" : ", ") + std::string(one->ifa_name) + " (" + address + ")";
  }
  throw SetupError("there is no interface " + wanted + " with an IPv4 address; there are " + known);
}

in_addr resolve(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (failure != 0) throw SetupError("peer " + host + " has no IPv4 address: " + gai_strerror(failure));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  return address_in(found->ai_addr);
}

}  // namespace

Location locate(std::string_view interface, std::span<const std::string_view> peers) {
  Location location = find_interface(interface.empty() ? "lo" : std::string(interface));
  if (!location.is_loopback && peers.empty())
    throw SetupError("interface " + std::string(interface) +
                     " needs peers: the hosts of the other processes (there is no multicast)");
  location.peers.push_back(location.address);
  for (const std::string_view peer : peers) {
    const in_addr address = resolve(std::string(peer));
    if (is_loopback(address)) continue;  // this host, which is there already
    const std::string text = text_of(address);
    if (location.is_loopback)
      throw SetupError("peer " + std::string(peer) + " (" + text +
                       ") is on another host: name the interface that leads there");
    if (std::ranges::find(location.peers, text) == location.peers.end()) location.peers.push_back(text);
  }
  return location;
}

}  // namespace tessera::dds
