#include "timing/bounds.hpp"

#include <algorithm>
#include <numeric>

namespace tessera::timing {

/// The event that a hop leads to: the next write, or the command at the end.
EventId Bounds::next_of(const Chain& chain, std::size_t hop) const {
  const Events& events = events_.events();
  return hop + 1 < chain.size() ? events.write(chain[hop + 1])
                                : events.finish(events_.system().channels[chain[hop]].to);
}

Time Bounds::read_before(EventId read, EventId next, Time sent, Time given) const {
  const std::uint32_t i = events_.events()[read].subsystem;
  const Time begin = given - events_.since_start(next);
  const Time at = events_.periodic(i)
                      ? begin - events_.system().subsystems[i].period + events_.since_start(read)
                      : given - events_.once(read, next);
  return std::max(sent, std::min(at, begin));
}

ChainBound Bounds::sum(const Chain& chain) const { return sum(chain, nullptr); }

ChainBound Bounds::sum(const Chain& chain, ChainRoutes* routes) const {
  const Events& events = events_.events();
  const EventId begin = events.start(events_.system().channels[chain.front()].from),
                first_write = events.write(chain.front());
  Time written = events_.once(begin, first_write), replaced = events_.twice(begin, first_write),
       start = events_.first(first_write);
  if (routes != nullptr) *routes = {{written, {}}, {replaced, {}}};
  for (std::size_t hop = 0; hop < chain.size(); ++hop) {
    const EventId read = events.read(chain[hop]), next = next_of(chain, hop);
    const Time last = events_.last_read(chain[hop], written, replaced),
               on = plus(events_.until_read(chain[hop]), events_.once(read, next));
    const Time sent = written, sent_next = replaced;
    written = plus(last, events_.once(read, next));
    replaced = std::min(plus(last, events_.twice(read, next)), plus(replaced, on));
    start = plus(start, on);
    if (routes == nullptr) continue;
    routes->age.hops.push_back(
        {std::clamp(last, sent, std::max(sent, written - events_.since_start(next))), written});
    routes->reaction.hops.push_back({read_before(read, next, sent_next, replaced), replaced});
  }
  return {written, replaced, start, false};
}

ChainBound Bounds::chain(const Chain& chain) const {
  ChainBound result = sum(chain);
  enumerate(chain, result, nullptr);
  return result;
}

ChainRoutes Bounds::routes(const Chain& chain) const {
  ChainRoutes routes;
  ChainBound result = sum(chain, &routes);
  enumerate(chain, result, &routes);
  return routes;
}

Time Bounds::staleness(std::uint32_t channel) const {
  return std::min(events_.staleness(channel), clocked_.staleness(channel));
}

/// As `sum`, with absolute times, for each reading of the device until everything repeats.
void Bounds::enumerate(const Chain& chain, ChainBound& result, ChainRoutes* routes) const {
  const System& system = events_.system();
  const std::uint32_t root = system.channels[chain.front()].from;
  if (!clocked_.knows(root) || result.reaction >= unbounded) return;
  Time pattern = clocked_.pattern(root), settled = clocked_.settled(root);
  for (const std::uint32_t c : chain) {
    if (!events_.keeps_values(c)) return;
    const std::uint32_t to = system.channels[c].to;
    if (!clocked_.knows(to)) continue;
    const Time factor = clocked_.pattern(to) / std::gcd(pattern, clocked_.pattern(to));
    if (factor > unbounded / 8 / pattern) return;
    pattern *= factor;
    settled = std::max(settled, clocked_.settled(to));
  }
  const Events& events = events_.events();
  const Time end = settled + 2 * pattern, before = clocked_.before(root);
  const EventId write = events.write(chain.front());
  Time age = 0, reaction = 0;
  ChainRoutes worst;
  for (Time k = -before;; ++k) {
    if (k >= Clocked::most_iterations || k + 1 >= clocked_.numbers(root)) return;
    check(stop_);
    const Time reading = clocked_.earliest(events.start(root), k);
    if (reading > end) break;
    Moment written{clocked_.latest(write, k), k + before},
        replaced{clocked_.latest(write, k + 1), k + 1 + before};
    ChainRoutes way{{written.time - reading, {}, reading, pattern},
                    {replaced.time - reading, {}, reading, pattern}};
    for (std::size_t hop = 0; hop < chain.size(); ++hop) {
      if (!pass(chain[hop], next_of(chain, hop), written, replaced)) return;
      if (routes == nullptr) continue;
      way.age.hops.push_back({written.read - reading, written.time - reading});
      way.reaction.hops.push_back({replaced.read - reading, replaced.time - reading});
    }
    if (routes != nullptr && written.time - reading > age) worst.age = way.age;
    if (routes != nullptr && replaced.time - reading > reaction) worst.reaction = way.reaction;
    age = std::max(age, written.time - reading);
    reaction = std::max(reaction, replaced.time - reading);
  }
  if (routes != nullptr && age <= result.age) routes->age = worst.age;
  if (routes != nullptr && reaction <= result.reaction) routes->reaction = worst.reaction;
  result.enumerated = true;
  result.age = std::min(result.age, age);
  result.reaction = std::min(result.reaction, reaction);
}

/// From a write to that of the next subsystem. false: more iterations than were computed.
bool Bounds::pass(std::uint32_t channel, EventId next, Moment& written, Moment& replaced) const {
  const System& system = events_.system();
  const Events& events = events_.events();
  const std::uint32_t from = system.channels[channel].from, to = system.channels[channel].to;
  const EventId read = events.read(channel);
  Time last = replaced.time;
  if (events_.reads_new(channel))
    last = std::min(last, plus(written.time, std::max({events_.arrival(read), events_.wake_up(read),
                                                       minus(events_.first_arrival(read), written.time)})));
  Moment on{plus(last, events_.once(read, next))};
  Moment newer{std::min(plus(last, events_.twice(read, next)),
                        plus(replaced.time, plus(events_.until_read(channel), events_.once(read, next))))};
  const Time before = clocked_.before(from), before_receiver = clocked_.before(to);
  const auto at = [&](Time number) {
    return Moment{clocked_.latest(next, number), number + before_receiver};
  };
  if (clocked_.knows(to) && !clocked_.driver(to)) {
    if (events_.in_step(from, to) && events_.reads_new(channel) && written.number >= 0 &&
        replaced.number >= 0) {
      on = at(written.number + 1);
      newer = at(replaced.number + 1);
    } else {
      // The last receive that may come no later.
      const Time period = system.subsystems[to].period;
      on = at(floor_div(last - events.least(read), period) + 1);
      newer = at(floor_div(replaced.time - events.least(read), period) + 2);
    }
  } else if (clocked_.knows(to) && clocked_.driver(to) == channel && replaced.number >= 0) {
    if (replaced.number - before >= clocked_.numbers(to)) return false;
    if (written.number >= 0) on = at(written.number - before);
    newer = at(replaced.number - before);
  }
  on.read = std::clamp(last, written.time, std::max(written.time, on.time - events_.since_start(next)));
  newer.read = read_before(read, next, replaced.time, newer.time);
  written = on;
  replaced = newer;
  return true;
}

}  // namespace tessera::timing
