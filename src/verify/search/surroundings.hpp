#pragma once

#include <map>
#include <set>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// The part of a net in which all others but the peers of a subsystem give it whatever it wants. Peers use a channel with it.
///
/// The part of the net has the possible transitions of these subsystems, without the places of others, of
/// channels to others, and of the layers above. A marking that it cannot reach, the net cannot reach: to
/// take a place out of a net, with its arcs, lets every run of the net still be fired, and the transitions
/// that are left out touch none of the places that are left, except to start the subsystems, which are
/// started here. Places that are left keep their bound, as far as invariants over them show it.
///
/// Threads: const members from any thread.
class Surroundings {
 public:
  /// The net has to outlive this. Linear.
  explicit Surroundings(const net::Net& net);

  struct Part {
    net::Net net;
    std::map<net::PlaceId, net::PlaceId> place_of;  ///< by place of the whole net, if it is left
  };
  /// Linear in the transitions of the subsystem and its peers.
  [[nodiscard]] Part around(net::SubsystemId subsystem) const;

 private:
  [[nodiscard]] std::set<net::SubsystemId> with_peers(net::SubsystemId subsystem) const;
  [[nodiscard]] bool stays(net::PlaceId place, const std::set<net::SubsystemId>& subsystems) const;

  const net::Net& net_;
  std::vector<std::vector<net::TransitionId>> transitions_;       // per subsystem
  std::vector<std::set<net::SubsystemId>> users_;                 // per place of a channel
  std::map<net::ChannelId, std::set<net::SubsystemId>> members_;  // of a channel
  std::vector<bool> started_;                                     // per place: the layers above fill it
};

}  // namespace tessera::verify
