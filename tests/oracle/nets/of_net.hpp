// Nets of Tessera for the oracle, and back. It reads the flat net itself, not what others compile of it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "oracle/nets/petri_net.hpp"

namespace oracle {

enum class Conditions {
  as_known,  ///< a transition whose condition is never true does not fire
  free       ///< every condition may be true
};

/// Places and transitions keep their numbers.
[[nodiscard]] PetriNet petri_net(const tessera::net::Net& net, Conditions conditions = Conditions::as_known);
/// Places p0, p1, ..., transitions t0, t1, ...
[[nodiscard]] tessera::net::Net tessera_net(const PetriNet& net);

[[nodiscard]] Marking initial_marking(const tessera::net::Net& net);
/// The marking after a transition has fired; nullopt if it is not enabled or its condition is never true.
[[nodiscard]] std::optional<Marking> fired(const tessera::net::Net& net,
                                           tessera::net::TransitionId transition, const Marking& marking);
/// The marking after a run; nullopt: it cannot be fired.
[[nodiscard]] std::optional<Marking> replayed(const tessera::net::Net& net,
                                              const std::vector<tessera::net::TransitionId>& run);

}  // namespace oracle
