#pragma once

#include <cstdint>
#include <vector>

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

struct PropertyResult;

/// The assumption under which a property was judged, and its run is one.
[[nodiscard]] Assume assumed_by(const PropertyResult& property);

/// The net that is judged. Its conditions are free choices; a condition that is known never to hold is
/// marked so (Condition::Truth::never). If it can happen that no initial condition holds after a
/// behaviour, a transition "... none" is added for that outcome: it puts the token into a place
/// without output transitions.
///
/// Under Assume::partition each channel between processes has a link for its values, which delivery needs,
/// and one for its acknowledgements, which the end of a blocking send needs. A transition `cut` takes the link
/// away for ever. A peer that dies without return is a peer whose links are cut.
///
/// Places and transitions of `net` keep their ids; added ones follow them. Linear in the net.
[[nodiscard]] net::Net abstract_net(const net::Net& net, Assume assume = Assume::conditions);

/// Does a channel of the net cross processes?
[[nodiscard]] bool is_deployed(const net::Net& net);

/// The condition of the transition is not known to be always false.
[[nodiscard]] bool possible(const net::Net& net, net::TransitionId transition);

/// The net without the transitions that never fire. fires: if given, receives the id in `net` of each
/// transition that is left.
[[nodiscard]] net::Net possible_part(const net::Net& net, std::vector<net::TransitionId>* fires = nullptr);

/// An abstract net with probes: transitions by which it is checked what can happen again and again.
struct ProbedNet {
  /// The abstract net. For each subsystem that may end, a place is added that is marked once it has ended,
  /// and a probe: a transition without effect that needs this place. Added transitions come last.
  net::Net net;
  std::size_t transitions = 0;  ///< of the abstract net; the transitions after them are probes
  template <class Id>
  struct Set {
    Id id;
    std::vector<net::TransitionId> any_of;
  };
  /// From every marking, one of any_of can be fired at some time: then the subsystem goes on or has ended.
  std::vector<Set<net::SubsystemId>> subsystems;
  /// The same for a channel: it is received from again, or its receiver has ended.
  std::vector<Set<net::ChannelId>> channels;
};
[[nodiscard]] ProbedNet probed_net(const net::Net& abstract);

}  // namespace tessera::verify
