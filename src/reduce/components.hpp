#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::reduce {

/// A part of a net that shares no place with the other parts.
struct Component {
  std::vector<net::PlaceId> places;            ///< in canonical order
  std::vector<net::TransitionId> transitions;  ///< in canonical order
  /// Components of the same kind are equal: their n-th places have the same tokens and arcs, and their
  /// transitions are in corresponding sets.
  std::uint32_t kind = 0;
};

struct Components {
  std::vector<Component> all;
  std::uint32_t kinds = 0;  ///< it suffices to check one component of each kind
};

/// The connected components of a net, and which of them are equal, such as agents that are instances
/// of one template. Components are compared in an order that is computed from their structure and
/// from names without the numbers of agents ("robot[3]" is "robot[]"). Equal components may be missed;
/// different ones are never taken for equal.
///
/// sets: sets of transitions, as in Preserve; they are part of the comparison.
/// Threads: pure. A few linear passes and sorting.
[[nodiscard]] Components components(const net::Net& net,
                                    const std::vector<std::vector<net::TransitionId>>& sets = {});

/// "robot[3].control.in" without the indices of a fleet: "robot[].control.in".
[[nodiscard]] std::string template_name(const std::string& name);

}  // namespace tessera::reduce
