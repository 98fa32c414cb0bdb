#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::reduce {

/// A part of a net that shares no place with the rest.
struct Component {
  std::vector<net::PlaceId> places;            ///< in canonical order
  std::vector<net::TransitionId> transitions;  ///< in canonical order
  /// Components of the same kind are equal: the n-th place of one and the n-th of the other have the same
  /// tokens and arcs, and the transitions are in corresponding sets.
  std::uint32_t kind = 0;
};

struct Components {
  std::vector<Component> all;
  std::uint32_t kinds = 0;  ///< check one component of each
};

/// The connected components of a net, and which are equal: those of agents that are instances of one
/// template, above all. Components are compared in an order that is found from their structure and from names
/// without the numbers of agents ("robot[3]" is "robot[]"); equal ones may be missed, different ones are
/// never taken for equal.
///
/// sets: of transitions, as in Preserve; part of what is compared.
/// Threads: pure. A few linear passes and sorting.
[[nodiscard]] Components components(const net::Net& net,
                                    const std::vector<std::vector<net::TransitionId>>& sets = {});

/// "robot[3].control.in" without what tells agents of a fleet apart: "robot[].control.in".
[[nodiscard]] std::string template_name(const std::string& name);

}  // namespace tessera::reduce
