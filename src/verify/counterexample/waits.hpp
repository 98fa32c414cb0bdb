#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/subsystem_at_end.hpp"

namespace tessera::verify {

/// Describes in words which subsystems wait for each other in one marking of a net.
class Waits {
 public:
  /// tokens: of every place. Precondition: the net outlives this.
  Waits(const net::Net& net, std::vector<std::uint32_t> tokens);

  /// Can the subsystem fire something at once?
  [[nodiscard]] bool moves(net::SubsystemId subsystem) const;
  /// Has the subsystem started and ended?
  [[nodiscard]] bool has_ended(net::SubsystemId subsystem) const { return !acts_[subsystem.value]; }
  /// The waits of a subsystem without an enabled transition: "a.control waits for a value of
  /// b.control.y->a.control.x from b.control", or that none of its initial conditions held.
  [[nodiscard]] std::vector<SubsystemAtEnd> waits_of(net::SubsystemId subsystem) const;
  /// "a.control has ended"
  [[nodiscard]] SubsystemAtEnd ended(net::SubsystemId subsystem) const;

  /// The channel places without a token that keep its transitions from firing, if nothing else does.
  [[nodiscard]] std::set<std::uint32_t> lacking(net::SubsystemId subsystem) const;
  /// The subsystems that can put a token into the place, one of a channel. The waiting one is left out unless
  /// it is the only one.
  [[nodiscard]] std::set<net::SubsystemId> givers(std::uint32_t place, net::SubsystemId waiting) const;
  /// The transitions of a subsystem that put a token there and take none from there.
  [[nodiscard]] std::vector<net::TransitionId> giving(net::SubsystemId subsystem, std::uint32_t place) const;
  /// "a.control goes on and receives ... no more", for a reader and a place that its reads need.
  [[nodiscard]] SubsystemAtEnd takes_no_more(net::SubsystemId reader, std::uint32_t place) const;
  /// The action that a subsystem omits if it never puts a token into the place: "a.control goes on and sends
  /// ... no more".
  [[nodiscard]] SubsystemAtEnd gives_no_more(net::SubsystemId giver, std::uint32_t place) const;

  [[nodiscard]] const std::string& name(net::SubsystemId subsystem) const {
    return net_.parts()[subsystem].path;
  }
  /// The possible transitions of a subsystem (verify/communication/abstraction.hpp).
  [[nodiscard]] const std::vector<net::TransitionId>& transitions(net::SubsystemId subsystem) const {
    return transitions_[subsystem.value];
  }
  [[nodiscard]] std::size_t subsystems() const { return transitions_.size(); }

 private:
  /// The token that a subsystem waits for at a channel, or gives there.
  using Good = SubsystemAtEnd::Awaited;

  /// The subsystem that waits does not know what is on the way: places of a medium stand for what a
  /// peer has to do.
  [[nodiscard]] Good good_of(const net::Place& place) const;
  [[nodiscard]] bool crosses(const net::Place& place) const { return networked_[place.channel.value]; }
  [[nodiscard]] bool is_given(std::uint32_t place, const net::Arc& arc) const;
  [[nodiscard]] bool gives(net::TransitionId id, std::uint32_t place) const;
  void note_tokens();
  /// ", and the network is cut" at the link of a place's channel that the waiting subsystem needs.
  [[nodiscard]] std::string cut_at(const net::Place& place) const;

  /// Is it a place of a channel's memory into which no other subsystem can put a token?
  [[nodiscard]] bool is_own_memory(net::SubsystemId subsystem, std::uint32_t place) const;
  [[nodiscard]] SubsystemAtEnd wait_at(net::SubsystemId subsystem, std::uint32_t missing) const;
  /// The behaviour to which a place belongs, by its name; empty: to none.
  [[nodiscard]] std::string behaviour_left(std::uint32_t place) const;
  [[nodiscard]] const std::string& channel(const net::Place& place) const {
    return net_.parts()[place.channel];
  }

  const net::Net& net_;
  std::vector<std::uint32_t> tokens_;
  std::vector<std::vector<net::TransitionId>> transitions_;          // per subsystem
  std::vector<bool> networked_;                                      // per channel
  std::map<net::ChannelId, std::vector<net::TransitionId>> giving_;  // per channel: that put a token there
  std::vector<bool> acts_;                                           // per subsystem: it has not ended
};

/// The channel places without a token that keep the transitions from firing, if nothing else does. tokens:
/// of every place.
[[nodiscard]] std::set<std::uint32_t> lacking(const net::Net& net, const std::vector<std::uint32_t>& tokens,
                                              const std::vector<net::TransitionId>& transitions);

}  // namespace tessera::verify
