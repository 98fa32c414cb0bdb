#pragma once

#include <unistd.h>

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "network/carrier.hpp"

namespace tessera::test {

/// A deployment of three processes. Each test program has a domain of its own, since others may run beside it.
struct Crossing {
  static constexpr network::ProcessNumber office = 0, cart = 1, other_cart = 2;
  static constexpr network::ChannelNumber goal = 3, position = 4, picture = 5, other_goal = 6;
  static constexpr std::uint32_t small = 64, large = 1 << 20;

  std::string system = "crossing", net_hash = "00c0ffee";
  std::vector<std::string_view> processes{"office", "cart[0]", "cart[1]"};
  std::vector<network::ChannelSetup> channels{
      {goal, "office.goal->cart[0].goal", office, cart, small},
      {position, "cart[0].at->office.at", cart, office, small},
      {picture, "office.map->cart[0].map", office, cart, large},
      {other_goal, "office.goal->cart[1].goal", office, other_cart, small}};
  int domain = 1 + static_cast<int>(getpid()) % 229;
  std::chrono::nanoseconds liveliness = std::chrono::milliseconds(900);
  std::string interface;
  std::vector<std::string_view> peers;

  [[nodiscard]] network::CarrierSetup setup(network::ProcessNumber process, std::uint64_t incarnation) const {
    network::CarrierSetup made;
    made.system = system;
    made.net_hash = net_hash;
    made.process = process;
    made.processes = processes;
    made.incarnation = incarnation;
    made.liveliness = liveliness;
    made.domain = domain;
    made.interface = interface;
    made.peers = peers;
    made.channels = channels;
    return made;
  }
};

}  // namespace tessera::test
