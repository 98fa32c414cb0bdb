#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "explore/budget.hpp"
#include "explore/formula.hpp"
#include "net/net.hpp"
#include "verify/search/local_net.hpp"

namespace tessera::verify {

/// A small picture of a net around a few subsystems, its members.
///
/// Each place of the net is kept, or is one of several that count as one (their tokens are added), or is left out.
/// Kept are the places of members, of their channels and of what they know. The places of a peer, which is no member,
/// count as one, apart from those of its blocks of kept channels; so do the behaviours of a member with many
/// peers that concern no other member, and values of facts that no kept behaviour gives.
///
/// Each run of the net is a run of the picture, so that what no run of the picture reaches, no run of the net does. A
/// step of the picture is *certain* if the net can make it in every marking that looks like this: it needs no place
/// that is left out, and for every choice of the places that count as one there is a transition.
class LocalViews {
 public:
  /// The net has to outlive this. Transitions that never fire are left out. Linear.
  explicit LocalViews(const net::Net& net);

  using Members = std::set<net::SubsystemId>;
  /// The subsystems that share a channel with it.
  [[nodiscard]] const Members& peers(net::SubsystemId subsystem) const;
  [[nodiscard]] bool has_many_peers(net::SubsystemId subsystem) const {
    return peers(subsystem).size() > many_peers;
  }
  /// The subsystem of a place, or of the fact that it is a value of; invalid: of none.
  [[nodiscard]] net::SubsystemId owner(net::PlaceId place) const;

  /// A question about the markings of a picture.
  struct Question {
    using Kind = LocalNet::Kind;
    Kind kind = Kind::never;
    explore::Formula what{}, then{};
    std::vector<net::PlaceId> places{};       ///< of the formulas: they are kept
    std::vector<net::TransitionId> any_of{};  ///< if there are some, instead of `then`
  };
  struct Answer {
    bool known = false;  ///< otherwise the picture is too large
    bool holds = false;
    std::set<net::PlaceId> settled{};  ///< places that are marked in no marking where it may not hold
  };
  /// Throws explore::CutOff.
  [[nodiscard]] Answer judge(const Members& members, const Question& question, const explore::Budget& budget);

  static constexpr std::size_t many_peers = 1;
  static constexpr std::size_t most_markings = 60'000;

 private:
  class Picture;

  const net::Net& net_;
  std::vector<std::vector<net::TransitionId>> touching_;  // per place
  std::vector<std::vector<net::PlaceId>> places_;         // per subsystem, with its facts
  std::map<net::SubsystemId, Members> peers_;
  std::map<net::SubsystemId, std::vector<net::ChannelId>> channels_of_;
  std::map<net::ChannelId, std::vector<net::PlaceId>> places_of_channel_;
  std::map<net::ChannelId, Members> users_;
  std::vector<net::PlaceId> upper_;                               // of the layers above the subsystems
  std::vector<std::uint32_t> local_;                              // per place, while a picture is made
  std::map<std::string, std::optional<LocalNet::Doubts>> known_;  // by LocalNet::key
};

}  // namespace tessera::verify
