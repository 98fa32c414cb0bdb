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

/// Tracks which processes are reachable, from when they were last heard of, and reports each change to the
/// listener. It knows no middleware.
class Presence {
 public:
  explicit Presence(const Deployment& deployment);

  /// A message of this incarnation of a process has arrived. Processes that are no peers are ignored.
  void heard(ProcessNumber process, std::uint64_t incarnation, Clock::time_point now,
             network::Carrier::Listener& listener);
  /// That incarnation has announced its end.
  void left(ProcessNumber process, std::uint64_t incarnation, network::Carrier::Listener& listener);
  /// Reports the processes that have been silent for too long.
  void look(Clock::time_point now, network::Carrier::Listener& listener);
  /// When to call look() next; nullopt: no process is reachable.
  [[nodiscard]] std::optional<Clock::time_point> next_look() const;

 private:
  struct Peer {
    std::string name;
    std::uint64_t incarnation = 0;
    bool is_there = false;
    Clock::time_point heard;
    std::uint64_t older = 0;  ///< an older incarnation that still sends after a later one has begun
    int heard_of_older = 0;
  };
  void heard_older(Peer& peer, std::uint64_t incarnation, network::Carrier::Listener& listener);

  std::chrono::nanoseconds longest_silence_;
  std::map<ProcessNumber, Peer> peers_;
};

}  // namespace tessera::dds
