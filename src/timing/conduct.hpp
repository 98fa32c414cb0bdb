// Rates, waits, timeouts and stale inputs, as the bounds say them.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/declared.hpp"

namespace tessera::timing {

/// Whether something happens at run time.
enum class Fires : std::uint8_t {
  never,
  may,
  must  ///< in every run that goes on, again and again
};

/// Whether a subsystem begins an iteration at every instant of its rate.
struct RateVerdict {
  std::uint32_t subsystem = 0;
  bool keeps = false;
  Time period = 0;
  Time longest = unbounded;  ///< most between two iterations
  bool may_overrun = false;  ///< its own work may take longer than the period
  /// It may wait longest for this one; itself: it does not wait.
  std::uint32_t waits_for = 0;
};

/// A send or receive that waits.
struct WaitVerdict {
  std::uint32_t subsystem = 0, channel = 0;
  bool receives = false;
  Time longest = unbounded;
  Time timeout = 0;  ///< 0: it has none
  Fires fires = Fires::may;
  Time certain = 0;  ///< again and again, a wait lasts at least so long, if no timeout ends it
};

/// An input of an effector with `stale`.
struct StaleVerdict {
  std::uint32_t subsystem = 0, channel = 0;
  Time stale = 0;
  Time oldest = unbounded;  ///< the age of the value, counted from the write
  Fires fires = Fires::may;
  Time certain = 0;  ///< again and again, the value gets at least so old
};

struct Conduct {
  std::vector<RateVerdict> rates;  ///< of all subsystems with a rate
  std::vector<WaitVerdict> waits;
  std::vector<StaleVerdict> stale;
};

/// Precondition: the bounds are those of `declared.system`.
[[nodiscard]] Conduct conduct_of(const Declared& declared, const Bounds& bounds);

}  // namespace tessera::timing
