#include "ros2/dds/other_side.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <utility>

namespace tessera::ros2 {
namespace {

/// The first interface of this machine that is no loopback and has an IPv4 address; empty: there is none.
std::string another_interface() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  std::string name;
  for (const ifaddrs* one = first; one != nullptr && name.empty(); one = one->ifa_next)
    if (one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET && (one->ifa_flags & IFF_UP) != 0 &&
        (one->ifa_flags & IFF_LOOPBACK) == 0)
      name = one->ifa_name;
  freeifaddrs(first);
  return name;
}

/// Participants announce the addresses of their other interfaces rather than loopback. A driver that uses
/// loopback alone cannot reach those addresses.
std::string advice_for(const Network& network) {
  const std::string domain = "is ROS_DOMAIN_ID the same at the other side";
  if (!is_loopback(network))
    return network.peers.empty() ? domain + ", and does the network carry multicast (else name `peers`)?"
                                 : domain + ", and is its host one of the peers?";
  const std::string other = another_interface();
  if (other.empty()) return domain + "?";
  return "nodes that use the other interfaces of this machine cannot be reached over " + network.interface +
         ". Write `interface: " + other +
         "` into the driver, or start the nodes with ROS_LOCALHOST_ONLY=1 (ROS 2 Humble and older); see "
         "\"Network\" in docs/use/ros2.md";
}

}  // namespace

OtherSideWatch::OtherSideWatch(const EndpointSetup& setup, bool writes, Clock::time_point now,
                               std::atomic<bool>& advised)
    : path_(setup.path),
      what_(std::string(writes ? "subscribes to " : "publishes ") + setup.topic + " on interface " +
            setup.network.interface + " in domain " + std::to_string(setup.network.domain)),
      network_(setup.network),
      advised_(advised),
      alone_since_(now) {}

std::optional<std::string> OtherSideWatch::look(bool is_there, Clock::time_point now,
                                                const std::function<bool()>& is_misfit) {
  if (is_there) {
    alone_since_.reset();
    was_there_ = true;
    if (!std::exchange(told_, false)) return std::nullopt;
    return path_ + ": somebody " + what_;
  }
  if (!alone_since_) alone_since_ = now;
  if (told_ || now - *alone_since_ < patience) return std::nullopt;
  told_ = true;
  if (is_misfit()) return std::nullopt;
  std::string text = path_ + ": nobody " + what_;
  if (was_there_) return text + " any more";
  if (!advised_.exchange(true)) text += ": " + advice_for(network_);
  return text;
}

}  // namespace tessera::ros2
