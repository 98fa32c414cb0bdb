#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/carrier.hpp"

namespace tessera::dds {

using network::ChannelNumber;
using network::ProcessNumber;

struct Channel {
  std::string name;
  ProcessNumber sender = 0, receiver = 0;
  std::uint32_t longest_value_bytes = 0;
};

/// The facts of a system that a process is a part of: a CarrierSetup, copied and checked.
struct Deployment {
  std::string system, net_hash;
  std::string processes_hash;  ///< 16 hexadecimal digits, of the names of all processes and of the liveliness
  ProcessNumber process = 0;   ///< this one
  std::uint64_t incarnation = 0;
  std::chrono::nanoseconds liveliness{0};  ///< a process that is silent for longer is not reachable

  /// The period of the signs of life of a process. Five in a row may be lost.
  [[nodiscard]] std::chrono::nanoseconds sign_of_life_period() const { return liveliness / 6; }

  std::vector<std::string> processes;  ///< names, by number
  std::unordered_map<ChannelNumber, Channel> channels;
  std::vector<ProcessNumber> peers;  ///< the processes that share a channel with this one, in ascending order

  [[nodiscard]] const Channel* channel(ChannelNumber number) const;
  /// Whether there is a channel on which this process sends values to `peer`, or receives them from it.
  [[nodiscard]] bool sends_to(ProcessNumber peer) const;
  [[nodiscard]] bool receives_from(ProcessNumber peer) const;
  /// The size of the longest value that this process receives.
  [[nodiscard]] std::uint32_t longest_received_bytes() const;
};

/// Errors: SetupError if the setup contradicts itself.
[[nodiscard]] Deployment deployment_of(const network::CarrierSetup& setup);

}  // namespace tessera::dds
