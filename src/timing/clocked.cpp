#include "timing/clocked.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tessera::timing {

Clocked::Clocked(const Occurrences& bounds) : bounds_(bounds), all_(bounds.system().subsystems.size()) {
  for (std::uint32_t i = 0; i < all_.size(); ++i)
    if (bounds.periodic(i)) {
      all_[i].known = true;
      all_[i].pattern = bounds.system().subsystems[i].period;
    }
  for (bool found = true; found;) {
    found = false;
    for (std::uint32_t i = 0; i < all_.size(); ++i)
      if (!all_[i].known && drive(i)) found = true;
  }
}

Time Clocked::numbers(std::uint32_t subsystem) const {
  const One& one = all_[subsystem];
  return one.driver ? static_cast<Time>(one.start.size()) - one.before : unbounded;
}
Time Clocked::call_time(std::uint32_t subsystem) const {
  return plus(bounds_.response(subsystem),
              bounds_.system().subsystems[subsystem].period > 0 ? bounds_.system().latency : 0);
}
Time Clocked::latest(EventId y, Time number) const {
  const std::uint32_t i = bounds_.events()[y].subsystem;
  const One& one = all_[i];
  if (!one.driver) return plus(number * bounds_.system().subsystems[i].period, bounds_.since_start(y));
  return plus(one.start[static_cast<std::size_t>(number + one.before)], call_time(i));
}
Time Clocked::earliest(EventId y, Time number) const {
  const std::uint32_t i = bounds_.events()[y].subsystem;
  const One& one = all_[i];
  const Time start = one.driver ? one.earliest[static_cast<std::size_t>(number + one.before)]
                                : number * bounds_.system().subsystems[i].period;
  return start + bounds_.events().least(y);
}

/// The channel of the only wait of the subsystem.
std::optional<std::uint32_t> Clocked::driver_of(std::uint32_t subsystem) const {
  const Subsystem& one = bounds_.system().subsystems[subsystem];
  std::optional<std::uint32_t> driver;
  for (const std::uint32_t c : one.sends)
    if (bounds_.system().channels[c].send_blocks) return std::nullopt;
  for (const std::uint32_t c : one.receives) {
    if (!bounds_.system().channels[c].receive_blocks) continue;
    // Nothing is known of the instants of another process.
    if (driver || !bounds_.reads_new(c) || !bounds_.keeps_values(c) || bounds_.system().crosses(c))
      return std::nullopt;
    driver = c;
  }
  return driver;
}

bool Clocked::drive(std::uint32_t subsystem) {
  if (bounds_.begins_late(subsystem) || bounds_.response(subsystem) >= unbounded) return false;
  const std::optional<std::uint32_t> driver = driver_of(subsystem);
  if (!driver) return false;
  const EventId write = bounds_.events().write(*driver), read = bounds_.events().read(*driver);
  const std::uint32_t from = bounds_.system().channels[*driver].from;
  const One& source = all_[from];
  const Time arrival = bounds_.arrival(read), wake_up = bounds_.wake_up_of(subsystem);
  if (!source.known || arrival >= unbounded || bounds_.first(read) >= unbounded) return false;
  const Time period = bounds_.system().subsystems[subsystem].period;
  One mine;
  mine.driver = driver;
  mine.pattern = source.pattern;
  if (period > 0) {
    const Time factor = period / std::gcd(source.pattern, period);
    if (factor > most_iterations) return false;
    mine.pattern *= factor;
  }
  mine.repeat = mine.pattern / source.pattern * source.repeat;
  if (mine.repeat * 4 > most_iterations) return false;
  const Time limit = std::min({numbers(from), most_iterations, 12 * mine.repeat + 400});
  // The first iteration uses no value.
  mine.before = source.before + 1;
  mine.start.push_back(bounds_.begin(subsystem));
  mine.earliest.push_back(0);
  for (Time k = -source.before; k < limit; ++k) {
    const Time back = mine.start.back() + call_time(subsystem), written = latest(write, k);
    // A subsystem that is late for one value is less late for the next, and never by more than a round of its own.
    const Time received =
        std::min(std::max(back, written + wake_up),
                 std::max(written + std::max(arrival, wake_up), bounds_.first_arrival(read)));
    mine.read.push_back(received);
    if (period > 0) {
      mine.start.push_back(std::max(mine.start.back() + period, ceil_div(received, period) * period));
      mine.earliest.push_back(std::max(ceil_div(earliest(write, k), period) * period, mine.earliest.back()));
    } else {
      mine.start.push_back(received);
      mine.earliest.push_back(earliest(write, k));
    }
  }
  // From `same` on, everything is as it was a pattern before.
  const auto count = static_cast<Time>(mine.start.size());
  Time same = count;
  const auto repeats = [&](const std::vector<Time>& times) {
    return times[static_cast<std::size_t>(same - 1)] ==
           times[static_cast<std::size_t>(same - 1 - mine.repeat)] + mine.pattern;
  };
  while (same > mine.repeat && repeats(mine.start) && repeats(mine.earliest)) --same;
  if (count - same < 2 * mine.repeat) return false;
  mine.settled = std::max(source.settled, mine.start[static_cast<std::size_t>(same - mine.repeat)]);
  mine.known = true;
  all_[subsystem] = std::move(mine);
  return true;
}

/// The iteration after that of a value uses the next value, or a newer one.
Time Clocked::gap(std::uint32_t subsystem) const {
  const One& one = all_[subsystem];
  if (!one.known) return unbounded;
  if (!one.driver) return bounds_.system().subsystems[subsystem].period;
  Time most = 0;
  for (std::size_t k = 0; k + 1 < one.start.size(); ++k)
    most = std::max(most, one.start[k + 1] - one.earliest[k]);
  return most;
}

Time Clocked::staleness(std::uint32_t channel) const {
  const Channel& one = bounds_.system().channels[channel];
  const One& receiver = all_[one.to];
  if (!receiver.known || receiver.driver != channel) return unbounded;
  Time most = 0;
  for (std::size_t k = 0; k + 1 < receiver.read.size(); ++k)
    most = std::max(most, receiver.read[k + 1] - earliest(bounds_.events().write(channel),
                                                          static_cast<Time>(k) - all_[one.from].before));
  return most;
}

}  // namespace tessera::timing
