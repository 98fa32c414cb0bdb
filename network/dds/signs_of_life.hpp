#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/carrier.hpp"
#include "network/clock_offset.hpp"
#include "network/dds/deployment.hpp"
#include "wire.h"

namespace tessera::dds {

/// Measures the links to other processes by their signs of life: how many are lost, and how far the clocks
/// differ. Each sign carries its number and its times, and echoes the newest sign of one peer; the peers take
/// turns. It calls neither the middleware nor a clock.
///
/// Threads: one at a time. After the construction, no member allocates.
class SignsOfLife {
 public:
  using Duration = std::chrono::nanoseconds;
  explicit SignsOfLife(const Deployment& deployment);

  /// The next sign of this process. steady, wall: its two clocks now.
  [[nodiscard]] tessera_wire_Alive next(Duration steady, Duration wall);
  /// Takes and checks a sign of a peer. nullopt: its incarnation is older than one that was heard.
  [[nodiscard]] std::optional<network::SignsOfLife> hear(const tessera_wire_Alive& sign, Duration steady,
                                                         Duration wall);

 private:
  struct Peer {
    ProcessNumber process = 0;
    std::uint64_t incarnation = 0;  ///< 0: no sign has arrived yet
    std::uint64_t newest = 0;       ///< number of the newest sign
    std::uint64_t seen = 0;         ///< bit i: the sign with number newest - i has come
    std::uint32_t expected = 0;
    Duration its_time{}, came{};  ///< times of the newest sign
    network::ClockOffsetEstimate clock{};
  };
  void take_number(Peer& peer, std::uint64_t number) const;
  void take_echo(Peer& peer, const tessera_wire_Alive& sign, Duration steady, Duration wall) const;

  ProcessNumber process_;
  std::uint64_t incarnation_;
  std::uint64_t number_ = 0;
  std::size_t turn_ = 0;
  std::vector<Peer> peers_;  ///< in ascending order of their processes
};

}  // namespace tessera::dds
