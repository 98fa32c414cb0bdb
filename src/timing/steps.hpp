// The parts of a bound: where its time goes.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/declared.hpp"

namespace tessera::timing {

/// A part of an age or a reaction. The parts follow one another, and add up to the bound.
struct Step {
  enum class Kind : std::uint8_t {
    next_reading,  ///< an event comes just after a reading: until the next one
    network,       ///< the value is on the way to another process
    foreign,       ///< something that is not of this system answers: DeclaredChain::foreign[channel]
    until_read,    ///< the value stands in the channel until it is received, for an age the last time
    until_begin,   ///< what is received at the end of an iteration is used in the next one: until that begins
    latency,       ///< a thread goes on later than it may
    processor,     ///< others go first on the processor
    takes,         ///< the transition function and its devices
    until_sent     ///< transfers before this one wait
  };
  Kind kind = Kind::takes;
  std::uint32_t subsystem = 0;
  std::uint32_t channel = 0;  ///< of until_read and network: over which the value comes
  Time time = 0;              ///< > 0

  bool operator==(const Step&) const = default;
};

struct ChainSteps {
  std::vector<Step> age, reaction;
};

/// Those of the way with the largest age, and of the one with the largest reaction. Precondition: there is a way, and
/// all have bounds. foreign: the hops of all ways over something that is not of this system.
[[nodiscard]] ChainSteps steps_of(const Bounds& bounds, const std::vector<Chain>& ways,
                                  const std::vector<ForeignHop>& foreign = {});

}  // namespace tessera::timing
