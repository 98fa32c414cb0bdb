#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/carrier.hpp"
#include "network/clock_offset.hpp"
#include "network/dds/deployment.hpp"
#include "network/dds/received.hpp"

namespace tessera::dds {

/// What the signs of life of other processes tell of the way to them: how many are lost, and how far clocks
/// differ. Each sign carries its number and its times, and echoes the newest sign of one peer, of each in turn.
/// It knows no middleware and no clock.
///
/// Threads: one at a time. After it was made, no member allocates.
class SignsOfLife {
 public:
  using Duration = std::chrono::nanoseconds;
  explicit SignsOfLife(const Deployment& deployment);

  /// The next sign of this process. steady, wall: its two clocks now.
  [[nodiscard]] ReceivedAlive next(Duration steady, Duration wall);
  /// A sign of a peer has come, which is checked. nullopt: of an incarnation older than one that was heard.
  [[nodiscard]] std::optional<network::SignsOfLife> hear(const ReceivedAlive& sign, Duration steady,
                                                         Duration wall);

 private:
  struct Peer {
    ProcessNumber process = 0;
    std::uint64_t incarnation = 0;  ///< 0: not heard yet
    std::uint64_t newest = 0;       ///< number of a sign
    std::uint64_t seen = 0;         ///< bit i: the sign with number newest - i has come
    std::uint32_t expected = 0;
    Duration its_time{}, came{};  ///< of the newest sign
    network::ClockOffsetEstimate clock{};
  };
  void take_number(Peer& peer, std::uint64_t number) const;
  void take_echo(Peer& peer, const ReceivedAlive& sign, Duration steady, Duration wall) const;

  ProcessNumber process_;
  std::uint64_t incarnation_;
  std::uint64_t number_ = 0;
  std::size_t turn_ = 0;
  std::vector<Peer> peers_;  ///< in ascending order of their processes
};

}  // namespace tessera::dds
