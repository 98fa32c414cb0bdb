// How far apart the events of a system are at most: gaps, first occurrences, waits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "timing/events.hpp"
#include "timing/responses.hpp"

namespace tessera::timing {

/// Bounds for the occurrences of all events of a system that goes on.
///
/// An event graph with one token on the edge from the end of an iteration to the next release; receives and sends
/// that wait add edges. Timeouts are assumed not to fire, as long as that agrees with the waits that follow from it.
/// Source: Baccelli, Cohen, Olsder, Quadrat, Synchronization and Linearity, 1992, for event graphs; the bounds of
/// single rounds are of Tessera (docs/theory/timing.md).
class Occurrences {
 public:
  enum class Wait : std::uint8_t {
    none,
    strict,  ///< until the other side comes
    lossy,   ///< the other side may let go
    timed    ///< its timeout may fire
  };

  /// Precondition: the channels of the system join its subsystems, each one once. Throws Interrupted.
  explicit Occurrences(const System& system, StopAsked stop = {});

  [[nodiscard]] const System& system() const { return system_; }
  [[nodiscard]] const Events& events() const { return events_; }

  [[nodiscard]] Time gap(EventId y) const { return gap_[y]; }      ///< most between two occurrences
  [[nodiscard]] Time first(EventId y) const { return first_[y]; }  ///< latest first occurrence
  [[nodiscard]] Time wait(EventId y) const { return wait_[y]; }    ///< longest wait at an event
  /// From the release of the iteration to the event, at most.
  [[nodiscard]] Time since_start(EventId y) const { return since_start_[y]; }
  [[nodiscard]] Time response(std::uint32_t subsystem) const { return responses_[subsystem].call; }
  /// From the moment that the subsystem of the event may go on until it does.
  [[nodiscard]] Time wake_up(EventId y) const { return late_[events_[y].subsystem]; }
  [[nodiscard]] Time wake_up_of(std::uint32_t subsystem) const { return late_[subsystem]; }
  /// An iteration begins at every instant of its grid.
  [[nodiscard]] bool periodic(std::uint32_t subsystem) const { return periodic_[subsystem]; }
  /// Both keep the same releases, and each round is done within one of them.
  [[nodiscard]] bool in_step(std::uint32_t a, std::uint32_t b) const {
    return in_step_[a] >= 0 && in_step_[a] == in_step_[b];
  }
  /// The timeout of that send or receive. 0: it has none.
  [[nodiscard]] Time timeout_of(EventId z) const;
  [[nodiscard]] bool timeout_never_fires(EventId z) const { return never_fires_[z]; }
  /// The subsystem's own work takes at most a period, so no overruns are counted.
  [[nodiscard]] bool never_overruns(std::uint32_t subsystem) const;
  /// Its iterations may begin later than a release of their own.
  [[nodiscard]] bool begins_late(std::uint32_t subsystem) const {
    return system_.subsystems[subsystem].catch_up && !never_overruns(subsystem);
  }
  /// No value is taken back before it was read.
  [[nodiscard]] bool keeps_values(std::uint32_t channel) const;
  /// Its receives wait for new values.
  [[nodiscard]] bool reads_new(std::uint32_t channel) const;
  [[nodiscard]] Wait wait_of(EventId z) const;
  /// When a value has arrived at the other end of its channel that is written by `written`, which counts from any
  /// moment of the run. Before a sender has heard of its receiver, its values are on the way for longer.
  [[nodiscard]] Time arrived(std::uint32_t channel, Time written) const;
  /// A send or receive of its iterations waits for others.
  [[nodiscard]] bool waits(std::uint32_t subsystem) const;

  /// The latest y that comes next, counted from x; both are of one subsystem, or of one component.
  [[nodiscard]] Time span(EventId x, EventId y) const;
  /// From one completion of a receive to the arrival at the next.
  [[nodiscard]] Time arrival(EventId read) const;
  [[nodiscard]] Time first_arrival(EventId read) const;
  /// From the arrival of a value to the first receive after it.
  [[nodiscard]] Time until_read(std::uint32_t channel) const;
  /// How long ago the value in an input may have been written, at any time after the first value.
  [[nodiscard]] Time staleness(std::uint32_t channel) const;
  /// When the first value is there.
  [[nodiscard]] Time first_value(std::uint32_t channel) const;
  /// From x to the next y of the same subsystem; from a release, to that of its iteration.
  [[nodiscard]] Time once(EventId x, EventId y) const;
  /// To the y after that.
  [[nodiscard]] Time twice(EventId x, EventId y) const;
  /// When a value is received for the last time at the latest, if it was written, and replaced, then at the latest.
  [[nodiscard]] Time last_read(std::uint32_t channel, Time written, Time replaced) const;
  /// Least time between two occurrences of an event. Precondition: it is no release.
  [[nodiscard]] Time least_gap(EventId y) const { return least_between(y, y); }
  /// When the first iteration begins, if it has no release to count from.
  [[nodiscard]] Time begin(std::uint32_t subsystem) const {
    return system_.subsystems[subsystem].period > 0 ? 0 : late_[subsystem];
  }

 private:
  struct Component {
    std::vector<EventId> events;
    std::vector<std::uint32_t> subsystems;
    std::vector<std::vector<Time>> rows;  ///< [from][to], by place; empty: `everything` bounds all
    Time everything = unbounded;          ///< more than any row
  };
  friend class Rows;

  void assume_and_judge();
  void find_components();
  void judge(Component& component);
  void bound_own_waits(const Component& component);
  [[nodiscard]] bool find_first(const Component& component);
  void measure_work(const Component& component);
  void keep_step(const Component& component);
  void find_periodic(const Component& component);
  [[nodiscard]] Time longest_wait(EventId z) const;

  /// The other event of a wait: a write or a read.
  [[nodiscard]] EventId partner_of(EventId z) const {
    return events_[z].kind == Event::Kind::acked ? events_.read(events_[z].channel)
                                                 : events_.write(events_[z].channel);
  }
  [[nodiscard]] bool same_component(EventId a, EventId b) const {
    return component_of_[a] == component_of_[b];
  }
  /// The other side cannot let go: its next occurrence after ours ends our wait.
  [[nodiscard]] bool holds_on(EventId z) const;
  /// From the event that ends a wait until the other process knows of it.
  [[nodiscard]] Time on_the_way(EventId z) const {
    return system_.crosses(events_[z].channel) ? system_.channels[events_[z].channel].network : 0;
  }
  /// The latest first occurrence of the other event of a wait, if it can end the wait after `on_the_way`.
  [[nodiscard]] Time first_of_partner(EventId z) const {
    const Time first = first_[partner_of(z)];
    return events_[z].kind == Event::Kind::read ? std::max(first, on_the_way(z)) : first;
  }
  /// A wait that ends with the first occurrence of the partner's event after our last one.
  [[nodiscard]] bool is_entry(EventId y) const;
  /// The time that y adds to the events before it, waits for others left out.
  [[nodiscard]] Time weight(EventId y) const;
  /// Least time from an event of one iteration to one of the next.
  [[nodiscard]] Time least_between(EventId y, EventId x) const;

  const StopAsked stop_;
  const System system_;
  const Events events_;
  const std::vector<Response> responses_;
  std::vector<Time> late_;  ///< per subsystem: latency and dispatch
  std::vector<Time> gap_, first_, wait_, since_start_, own_wait_, work_;
  std::vector<bool> never_fires_, held_up_;
  std::vector<bool> periodic_;
  std::vector<std::int64_t> in_step_;  ///< per subsystem: its component; -1: it is not in step
  std::vector<Component> components_;
  std::vector<std::uint32_t> component_of_, place_in_;
  bool timed_as_strict_ = false;
};

}  // namespace tessera::timing
