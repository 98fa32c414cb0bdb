#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "network/carrier.hpp"
#include "network/dds/deployment.hpp"

namespace tessera::dds {

using Clock = std::chrono::steady_clock;

/// Which processes are there, from what has been heard of them, and when. Tells the listener of each change.
/// It knows no middleware.
class Presence {
 public:
  explicit Presence(const Deployment& deployment);

  /// Something has come from this incarnation of a process. Others than peers are ignored.
  void heard(ProcessNumber process, std::uint64_t incarnation, Clock::time_point now,
             network::Carrier::Listener& listener);
  /// That incarnation has taken its leave.
  void left(ProcessNumber process, std::uint64_t incarnation, network::Carrier::Listener& listener);
  /// Looks whose silence has become too long.
  void look(Clock::time_point now, network::Carrier::Listener& listener);
  /// When to look next; nullopt: nobody is there.
  [[nodiscard]] std::optional<Clock::time_point> next_look() const;

 private:
  struct Peer {
    std::string name;
    std::uint64_t incarnation = 0;
    bool is_there = false;
    Clock::time_point heard;
    std::uint64_t older = 0;  ///< an incarnation that goes on speaking after a later one has begun
    int heard_of_older = 0;
  };
  void heard_older(Peer& peer, std::uint64_t incarnation, network::Carrier::Listener& listener);

  std::chrono::nanoseconds longest_silence_;
  std::map<ProcessNumber, Peer> peers_;
};

}  // namespace tessera::dds
