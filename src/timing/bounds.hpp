// Proved bounds for the time from a device to another one.
#pragma once

#include "timing/clocked.hpp"
#include "timing/occurrences.hpp"
#include "timing/patience.hpp"

namespace tessera::timing {

/// Bounds for a chain. A command reflects a reading if its value comes from it, or from a later one, along the chain;
/// values that a subsystem keeps in its memory do not count.
struct ChainBound {
  /// From the reading of the device to the end of any command, also a repeated one, that is based on it.
  Time age = unbounded;
  /// From an event at the device to the end of the first command that reflects a reading at or after it. It is also
  /// the age of the command in force, until a newer one replaces it.
  Time reaction = unbounded;
  Time start = unbounded;   ///< the reaction to what is there at time 0
  bool enumerated = false;  ///< found value by value, not as a sum

  bool operator==(const ChainBound&) const = default;
};

/// The way of a value to the command, at the times of a bound. All are counted from the reading, or from the event.
struct Route {
  struct Hop {
    Time read = 0;   ///< by the subsystem that the channel leads to
    Time given = 0;  ///< by it: the write of the next channel, or the end of the command
  };
  Time sent = 0;  ///< the first write
  std::vector<Hop> hops;
  /// When the device is read in that run, and after how long everything repeats. -1 and 0: it was not enumerated.
  Time reading = -1, pattern = 0;
};
struct ChainRoutes {
  Route age;       ///< ends at ChainBound::age
  Route reaction;  ///< of the reading after the event; ends at ChainBound::reaction
};

/// Bounds for all that can happen in a system, if it goes on, nobody ends, no call takes longer than declared, and no
/// wake-up is later than the latency.
///
/// Threads: const member functions may be called from several.
/// Source: docs/theory/timing.md. Feiertag et al., 2009, for age and reaction; Guenzel et al., 2023, for their equality.
class Bounds {
 public:
  /// Precondition: each channel is sent and received once, by the subsystems at its ends.
  /// Throws Interrupted, as soon as `stop` says so; so does `chain`.
  explicit Bounds(const System& system, const StopAsked& stop = {})
      : stop_(stop), events_(system, stop), clocked_(events_) {}
  Bounds(const Bounds&) = delete;
  Bounds& operator=(const Bounds&) = delete;

  [[nodiscard]] const Occurrences& occurrences() const { return events_; }
  /// Precondition: each channel of the chain ends where the next one begins.
  [[nodiscard]] ChainBound chain(const Chain& chain) const;
  /// Precondition: it has a bound.
  [[nodiscard]] ChainRoutes routes(const Chain& chain) const;
  /// The sum of its hops alone, which is at least as large.
  [[nodiscard]] ChainBound sum(const Chain& chain) const;
  /// How long ago the value in an input may have been written, at any time after the first value.
  [[nodiscard]] Time staleness(std::uint32_t channel) const;

 private:
  /// The writes of a value and of its successor by the last subsystem so far, at the latest.
  struct Moment {
    Time time = 0;
    Time number = -1;  ///< of the iteration, counted from the first one; -1: it is not known
    Time read = 0;     ///< what it is based on
  };

  /// routes: nullptr: they are not asked for.
  [[nodiscard]] ChainBound sum(const Chain& chain, ChainRoutes* routes) const;
  void enumerate(const Chain& chain, ChainBound& result, ChainRoutes* routes) const;
  [[nodiscard]] bool pass(std::uint32_t channel, EventId next, Moment& written, Moment& replaced) const;
  /// When the value was read on which `given` is based, if it came at `sent`.
  [[nodiscard]] Time read_before(EventId read, EventId next, Time sent, Time given) const;
  [[nodiscard]] EventId next_of(const Chain& chain, std::size_t hop) const;

  StopAsked stop_;
  Occurrences events_;
  Clocked clocked_;
};

}  // namespace tessera::timing
