#pragma once

#include <cstdint>
#include <vector>

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// The net that is judged: conditions are free choices, what is known never to hold is marked so
/// (Condition::Truth::never), and a behaviour after which no initial condition may hold has that as an
/// outcome: a transition "... none" that puts its token into a place from which nothing leads on.
///
/// Places and transitions of `net` keep their ids; what is added follows them. Linear in the net.
[[nodiscard]] net::Net abstract_net(const net::Net& net, Assume assume = Assume::conditions);

/// Its condition is not known to be false always.
[[nodiscard]] bool possible(const net::Net& net, net::TransitionId transition);

/// A net without the transitions that never fire. fires: if given, their ids in `net`, for those that are
/// left.
[[nodiscard]] net::Net possible_part(const net::Net& net, std::vector<net::TransitionId>* fires = nullptr);

/// An abstract net with a probe for everything that has to be possible again and again.
struct ProbedNet {
  /// The abstract net; per subsystem that may end a place that is marked once it has, and a probe, a
  /// transition without effect, that needs it. Added transitions follow those of the abstract net.
  net::Net net;
  std::size_t transitions = 0;  ///< of the abstract net; those after are probes
  struct Set {
    std::uint32_t id = 0;  ///< subsystem or channel of the model
    std::vector<net::TransitionId> any_of;
  };
  /// From every marking, one of any_of can be fired at some time: then the subsystem goes on or has ended.
  std::vector<Set> subsystems;
  /// The same for a channel: it is received from again, or its receiver has ended.
  std::vector<Set> channels;
};
[[nodiscard]] ProbedNet probed_net(const net::Net& abstract);

}  // namespace tessera::verify
