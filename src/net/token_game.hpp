#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/net.hpp"

/// The token game on a net as it is, one transition at a time. Conditions of transitions play no part. It
/// uses nothing of the firing of explore and runtime (tessera/firing.hpp): replay checks runs with it.
namespace tessera::net {

/// Tokens per place.
using Marking = std::vector<std::uint32_t>;

[[nodiscard]] Marking initial_marking(const Net& net);

/// Does its place hold as many tokens as an input arc takes?
[[nodiscard]] bool suffices(const Marking& marking, const Arc& input);
[[nodiscard]] bool enabled(const Net& net, TransitionId transition, const Marking& marking);

/// Precondition: enabled.
void fire(const Net& net, TransitionId transition, Marking& marking);
/// Fires all, in this order, or none. Returns false if one of them is not enabled when its turn comes.
[[nodiscard]] bool fire_all(const Net& net, std::span<const TransitionId> run, Marking& marking);

/// Precondition: the run can be fired from the initial marking.
[[nodiscard]] Marking marking_after(const Net& net, std::span<const TransitionId> run);

}  // namespace tessera::net
