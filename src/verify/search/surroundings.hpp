#pragma once

#include <map>
#include <set>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// The part of a net with one subsystem and its peers, which are the subsystems that use a channel with it.
/// All other subsystems give these whatever they wait for.
///
/// The part of the net has the possible transitions of these subsystems, without the places of others, of
/// channels to others, and of the layers above. If the part cannot reach a marking, the net cannot reach it.
/// For if a place is removed from a net with its arcs, every run of the net can still be fired. And the
/// transitions that are left out touch none of the remaining places, except to start the subsystems, which
/// are started here. Places that are left keep their bound, as far as invariants over them show it.
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
  /// Those that are possible. Precondition: the subsystem is one of the net.
  [[nodiscard]] const std::vector<net::TransitionId>& transitions(net::SubsystemId subsystem) const {
    return transitions_[subsystem.value];
  }
  /// The subsystems that use a place of a channel; an invalid one stands for the network. For other places there are none.
  [[nodiscard]] const std::set<net::SubsystemId>& users(net::PlaceId place) const {
    return users_[place.value];
  }
  /// The subsystems that use a channel.
  [[nodiscard]] const std::set<net::SubsystemId>& members(net::ChannelId channel) const;
  /// Whether all that use the channel are among these.
  [[nodiscard]] bool is_between(net::ChannelId channel, const std::set<net::SubsystemId>& subsystems) const;
  /// Whether the place is one of these subsystems, or of a channel that no other uses.
  [[nodiscard]] bool stays(net::PlaceId place, const std::set<net::SubsystemId>& subsystems) const;
  /// At the start.
  [[nodiscard]] std::uint32_t tokens(net::PlaceId place) const { return net_[place].tokens; }
  /// The subsystem that the place is part of, also in the memory of a channel: "in use". None: of no single one.
  [[nodiscard]] net::SubsystemId controlled_by(net::PlaceId place) const {
    return controlled_by_[place.value];
  }
  /// Whether the layers above put a token into the place.
  [[nodiscard]] bool is_started(net::PlaceId place) const { return started_[place.value]; }

 private:
  [[nodiscard]] std::set<net::SubsystemId> with_peers(net::SubsystemId subsystem) const;

  const net::Net& net_;
  std::vector<std::vector<net::TransitionId>> transitions_;       // per subsystem
  std::vector<std::set<net::SubsystemId>> users_;                 // per place of a channel
  std::map<net::ChannelId, std::set<net::SubsystemId>> members_;  // of a channel
  std::vector<net::SubsystemId> controlled_by_;                   // per place
  std::vector<bool> started_;                                     // per place: the layers above fill it
};

}  // namespace tessera::verify
