// The way of a value, from the bounds of single events.
#include <algorithm>

#include "timing/occurrences.hpp"

namespace tessera::timing {

Time Occurrences::span(EventId x, EventId y) const {
  const Component& component = components_[component_of_[x]];
  return component.rows.empty() ? component.everything : component.rows[place_in_[x]][place_in_[y]];
}

Time Occurrences::arrival(EventId read) const {
  const std::uint32_t subsystem = events_[read].subsystem;
  Time most = 0, in_period = 0;
  for (const EventId z : events_[read].before) {
    most = std::max(most, span(read, z));
    in_period = std::max(
        in_period, minus(plus(system_.subsystems[subsystem].period, since_start_[z]), events_.least(read)));
  }
  return periodic_[subsystem] ? std::min(most, in_period) : most;
}
Time Occurrences::first_arrival(EventId read) const {
  Time most = 0;
  for (const EventId z : events_[read].before) most = std::max(most, first_[z]);
  return most;
}

Time Occurrences::until_read(std::uint32_t channel) const {
  const EventId write = events_.write(channel), read = events_.read(channel);
  if (keeps_values(channel))
    return std::max({arrival(read), wake_up(read), minus(first_arrival(read), events_.least(write))});
  return reads_new(channel) ? std::max(gap_[read], minus(first_[read], events_.least(write))) : unbounded;
}
Time Occurrences::staleness(std::uint32_t channel) const {
  const EventId write = events_.write(channel), read = events_.read(channel);
  // The value is written at `least` or later, and the next one after a gap.
  if (keeps_values(channel))
    return plus(minus(arrived(channel, plus(events_.least(write), gap_[write])), events_.least(write)),
                until_read(channel));
  return reads_new(channel) ? plus(gap_[write], gap_[read]) : unbounded;
}
Time Occurrences::first_value(std::uint32_t channel) const {
  const EventId write = events_.write(channel), read = events_.read(channel);
  if (reads_new(channel)) return first_[read];
  if (!keeps_values(channel)) return unbounded;
  return plus(std::max(first_arrival(read), plus(arrived(channel, first_[write]), arrival(read))),
              wake_up(read));
}

Time Occurrences::once(EventId x, EventId y) const {
  const std::uint32_t subsystem = events_[x].subsystem;
  const EventId release = events_.start(subsystem);
  if (x == release) return since_start_[y];
  Time best = std::min(plus(span(x, release), since_start_[y]), span(x, y));
  if (periodic_[subsystem])
    best =
        std::min(best, minus(plus(system_.subsystems[subsystem].period, since_start_[y]), events_.least(x)));
  return best;
}
Time Occurrences::twice(EventId x, EventId y) const {
  const std::uint32_t subsystem = events_[x].subsystem;
  const EventId release = events_.start(subsystem);
  Time best = plus(once(x, y), gap_[y]);
  best = std::min(best, plus(plus(x == release ? 0 : span(x, release), gap_[release]), since_start_[y]));
  if (!periodic_[subsystem]) return best;
  const Time period = system_.subsystems[subsystem].period;
  return std::min(best, minus(plus((x == release ? 1 : 2) * period, since_start_[y]), events_.least(x)));
}

Time Occurrences::last_read(std::uint32_t channel, Time written, Time replaced) const {
  const EventId write = events_.write(channel);
  Time last = keeps_values(channel)
                  ? std::min(arrived(channel, replaced), arrived(channel, plus(written, gap_[write])))
                  : unbounded;
  // A new value was not there at the last receive.
  if (!reads_new(channel) || (system_.crosses(channel) && !keeps_values(channel))) return last;
  const EventId read = events_.read(channel);
  return std::min(
      last, plus(arrived(channel, written),
                 std::max({arrival(read), wake_up(read), minus(first_arrival(read), events_.least(write))})));
}

}  // namespace tessera::timing
