#include "timing/conduct/certain.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace tessera::timing {
namespace {
using Kind = Event::Kind;
}  // namespace

/// An iteration with a strict wait needs an occurrence of the other side of its own.
Certain::Certain(const Bounds& bounds)
    : events_(bounds.occurrences().events()), occurrences_(bounds.occurrences()), clocked_(bounds.clocked()) {
  const std::vector<Subsystem>& all = occurrences_.system().subsystems;
  std::vector<std::vector<std::uint32_t>> waiting(all.size());  // for this subsystem
  for (EventId z = 0; z < events_.size(); ++z)
    if (occurrences_.wait_of(z) == Occurrences::Wait::strict)
      waiting[events_[partner_of(z)].subsystem].push_back(events_[z].subsystem);
  std::vector<std::uint32_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  const auto own = [&](std::uint32_t i) { return std::max({all[i].period, all[i].shortest, Time{1}}); };
  std::ranges::sort(order, std::ranges::greater{}, own);
  mean_.assign(all.size(), 0);
  for (const std::uint32_t slowest : order) {
    std::vector<std::uint32_t> level{slowest};
    while (!level.empty()) {
      const std::uint32_t i = level.back();
      level.pop_back();
      if (mean_[i] > 0) continue;  // by a slower one
      mean_[i] = own(slowest);
      level.insert(level.end(), waiting[i].begin(), waiting[i].end());
    }
  }
}

EventId Certain::partner_of(EventId z) const {
  const std::uint32_t channel = events_[z].channel;
  return events_[z].kind == Kind::acked ? events_.read(channel) : events_.write(channel);
}

/// Whether the instants of the event are known, one by one. Those of a driven subsystem are known for its writes only.
bool Certain::knows(EventId partner) const {
  const std::uint32_t i = events_[partner].subsystem;
  return clocked_.knows(i) && (!clocked_.driver(i) || events_[partner].kind == Kind::write);
}
Time Certain::earliest(EventId partner, Time number) const { return clocked_.earliest(partner, number); }
Time Certain::latest(EventId partner, Time number) const { return clocked_.latest(partner, number); }

/// The partner repeats together with a subsystem of that period; 0: alone. count 0: that takes too long.
Certain::Pattern Certain::pattern_of(EventId partner, Time period) const {
  const std::uint32_t i = events_[partner].subsystem;
  const Time own = clocked_.pattern(i), other = period == 0 ? 1 : period / std::gcd(own, period);
  Pattern pattern{0, clocked_.repeat(i)};
  if (other > Clocked::most_iterations / pattern.count) return {};
  pattern.count *= other;
  while (clocked_.driver(i) && pattern.first < clocked_.numbers(i) &&
         earliest(partner, pattern.first) < clocked_.settled(i))
    ++pattern.first;
  if (pattern.first + pattern.count >= clocked_.numbers(i)) return {};
  return pattern;
}

/// The latest arrival at z after one that was done at that time.
Time Certain::next_arrival(EventId z, Time done) const {
  const std::uint32_t i = events_[z].subsystem;
  const Time period = occurrences_.system().subsystems[i].period;
  const Time by_span = plus(done, occurrences_.arrival(z));
  if (period == 0 || occurrences_.begins_late(i)) return by_span;
  const Time end = plus(done, occurrences_.span(z, events_.end(i)));
  if (end >= unbounded) return by_span;
  Time release = ceil_div(end, period) * period;
  if (events_.least(z) == 0) release = std::max(release, (floor_div(done, period) + 1) * period);
  Time since = 0;
  for (const EventId y : events_[z].before) since = std::max(since, occurrences_.since_start(y));
  return std::min(by_span, plus(release, since));
}

/// The longest of the waits that surely occur in each pattern of the partner.
///
/// done(k): when an occurrence of the partner's event with number k, or a newer one, has ended a wait at the latest, or
/// its value has been taken. If that is before number k + 1 may occur, the next wait ends with that one, or later.
Time Certain::wait_by_number(EventId z) const {
  const EventId partner = partner_of(z);
  const bool sends = events_[z].kind == Kind::acked;
  if (!knows(partner) || (!sends && !occurrences_.keeps_values(events_[z].channel))) return 0;
  const Time wake_up = occurrences_.wake_up(z), arrival = occurrences_.arrival(z);
  if (arrival >= unbounded || latest(partner, 0) >= unbounded) return 0;
  const auto [first, count] =
      pattern_of(partner, occurrences_.system().subsystems[events_[z].subsystem].period);
  Time longest = 0, done = unbounded;
  for (Time k = first; k < first + count; ++k) {
    const Time late = latest(partner, k) + wake_up;
    // A value stays until it is taken. A receive that finds no send leaves nothing behind.
    const Time at_most = sends ? late : latest(partner, k) + std::max(arrival, wake_up);
    done = std::min(done >= unbounded ? at_most : std::max(next_arrival(z, done), late), at_most);
    const Time begin = next_arrival(z, done), end = earliest(partner, k + 1);
    if (sends && begin >= end) return 0;
    if (done < end) longest = std::max(longest, end - begin);
  }
  return longest;
}

/// If all waits were shorter, the iterations would come more often than the occurrences that they need.
Time Certain::wait_by_mean(EventId z) const {
  const std::uint32_t i = events_[z].subsystem;
  const Time mean = mean_[events_[partner_of(z)].subsystem],
             period = occurrences_.system().subsystems[i].period;
  Time wait = mean - occurrences_.arrival(z);
  if (period == 0 || occurrences_.begins_late(i)) return wait;
  // All that is shorter would end by this instant of the grid.
  const Time release = floor_div(mean - 1, period) * period;
  Time before = occurrences_.span(z, events_.end(i));
  Time since = 0;
  for (const EventId y : events_[z].before) since = std::max(since, occurrences_.since_start(y));
  before = plus(before, since);
  return before >= unbounded ? wait : std::max(wait, release - before + 1);
}

Time Certain::wait(EventId z) const {
  // A message may be on the way for longer than the next one.
  if (occurrences_.system().crosses(events_[z].channel)) return 0;
  const Time least_gap = occurrences_.least_gap(partner_of(z)), arrival = occurrences_.arrival(z);
  if (arrival >= unbounded || occurrences_.gap(partner_of(z)) >= unbounded) return 0;
  return std::max(
      {Time{0}, least_gap - arrival - occurrences_.wake_up(z), wait_by_mean(z), wait_by_number(z)});
}

bool Certain::times_out(EventId z) const {
  const Time timeout = occurrences_.timeout_of(z);
  return timeout > 0 && wait(z) > timeout + occurrences_.wake_up(z);
}

bool Certain::gets_stale(std::uint32_t channel, Time limit) const {
  constexpr Time least_more = 1;  // "older" is at least so much
  return staleness(channel) > limit + least_more + occurrences_.wake_up(events_.read(channel));
}

/// Until the next write may occur, the value in use is not newer than the one before.
Time Certain::staleness(std::uint32_t channel) const {
  const EventId write = events_.write(channel);
  Time oldest = occurrences_.least_gap(write);
  if (!knows(write) || latest(write, 0) >= unbounded) return oldest;
  const auto [first, count] = pattern_of(write, 0);
  for (Time k = first; k < first + count; ++k)
    oldest = std::max(oldest, earliest(write, k + 1) - latest(write, k));
  return oldest;
}

}  // namespace tessera::timing
