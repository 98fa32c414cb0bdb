// The gain of a chain by one change of the specification.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/declared.hpp"

namespace tessera::timing {

struct Change {
  enum class Kind : std::uint8_t {
    twice_the_rate,
    event_driven,   ///< no rate, and a receive over `channel` that waits
    receive_waits,  ///< `receive: blocking`
    receive_goes_on,
    send_waits,
    send_goes_on,
    own_processor
  };
  Kind kind = Kind::twice_the_rate;
  std::uint32_t subsystem = 0;
  std::uint32_t channel = 0;  ///< of the chain; of event_driven and of the modes
  /// The bounds with the change, larger of all ways of the chain. Others of the system may be affected as well.
  Time age = unbounded, reaction = unbounded;
};

/// All single changes of the subsystems and channels of a chain that make its age or its reaction smaller, and neither
/// larger; the one that helps most first. Each is computed by the bounds of the changed system. Throws Interrupted.
[[nodiscard]] std::vector<Change> changes_for(const Declared& declared, const DeclaredChain& chain,
                                              const StopAsked& stop = {});

/// The system with the change.
[[nodiscard]] System with_change(System system, const Change& change);

}  // namespace tessera::timing
