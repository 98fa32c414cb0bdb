#pragma once

#include <initializer_list>
#include <utility>

#include "net/net.hpp"

namespace tessera::explore {

/// A net of so many tokens per place.
[[nodiscard]] net::Net places_with(std::initializer_list<std::uint32_t> tokens);
/// Adds a transition; arcs are {place, weight}.
net::TransitionId join(net::Net& net, std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> inputs,
                       std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> outputs);

/// Places 0..n-1 in a circle, transition i from i to i + 1, the tokens in place 0.
[[nodiscard]] net::Net ring_of(std::uint32_t places, std::uint32_t tokens);
/// Place 0 is marked and has two ways out: transition 0 leads to place 1, which repeats for ever, and
/// transition 1 leads to place 2, a dead end.
[[nodiscard]] net::Net fork_in_the_road();
/// Dining philosophers that take one fork after the other, each its left one first: per philosopher the
/// places thinking, has left, eating, fork, and the transitions take left, take right, put back.
[[nodiscard]] net::Net philosophers(std::uint32_t count);
/// Transition 0 puts tokens into place 0 for ever.
[[nodiscard]] net::Net spring();

}  // namespace tessera::explore
