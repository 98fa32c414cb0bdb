// Lower bounds: how long waits last, and how old inputs get, whatever the calls take.
#pragma once

#include "timing/bounds.hpp"

namespace tessera::timing {

/// Events that occur again and again in every run that goes on: there is no last time.
///
/// Source: docs/theory/timing.md.
class Certain {
 public:
  /// Precondition: the bounds live as long as this.
  explicit Certain(const Bounds& bounds);

  /// Some wait at that send or receive lasts at least so long, or ends with its timeout. 0: nothing is known.
  [[nodiscard]] Time wait(EventId z) const;
  /// The timeout of that send or receive fires.
  [[nodiscard]] bool times_out(EventId z) const;
  /// The value in that input gets at least so old, counted from its write.
  [[nodiscard]] Time staleness(std::uint32_t channel) const;
  /// An input that may not be older than that is so, and the subsystem is awake to see it.
  [[nodiscard]] bool gets_stale(std::uint32_t channel, Time limit) const;

 private:
  /// The other event of the channel: a wait ends with it.
  [[nodiscard]] EventId partner_of(EventId z) const;
  [[nodiscard]] bool knows(EventId partner) const;
  [[nodiscard]] Time earliest(EventId partner, Time number) const;
  [[nodiscard]] Time latest(EventId partner, Time number) const;
  /// The first number from which on everything repeats, and how many numbers that takes.
  struct Pattern {
    Time first = 0, count = 0;
  };
  [[nodiscard]] Pattern pattern_of(EventId partner, Time period) const;
  [[nodiscard]] Time next_arrival(EventId z, Time done) const;
  [[nodiscard]] Time wait_by_number(EventId z) const;
  [[nodiscard]] Time wait_by_mean(EventId z) const;

  const Events& events_;
  const Occurrences& occurrences_;
  const Clocked& clocked_;
  std::vector<Time> mean_;  ///< per subsystem: in the long run, least time between its iterations
};

}  // namespace tessera::timing
