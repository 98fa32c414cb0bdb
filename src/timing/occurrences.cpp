#include "timing/occurrences.hpp"

#include <algorithm>
#include <utility>

#include "timing/graph.hpp"
#include "timing/rows.hpp"

namespace tessera::timing {

Occurrences::Occurrences(const System& system, StopAsked stop)
    : stop_(std::move(stop)),
      system_(system),
      events_(system_),
      responses_(responses_of(system_, stop_)),
      never_fires_(events_.size()) {
  for (const Response& response : responses_) late_.push_back(plus(system_.latency, response.dispatch));
  for (EventId z = 0; z < events_.size(); ++z) never_fires_[z] = timeout_of(z) > 0;
  // The first timeout that fires would do so although none before it has: those that can are taken out.
  for (bool consistent = false; !consistent;) {
    assume_and_judge();
    consistent = true;
    for (EventId z = 0; z < events_.size(); ++z)
      if (never_fires_[z] && wait_[z] >= timeout_of(z)) consistent = never_fires_[z] = false;
  }
}

// ------------------------------------------------------------------------------------------------- waits

Time Occurrences::timeout_of(EventId z) const {
  const Event& event = events_[z];
  const bool receives = event.kind == Event::Kind::read;
  if (!receives && event.kind != Event::Kind::acked) return 0;
  const Channel& channel = system_.channels[event.channel];
  if (!receives) return channel.send_timeout;
  return channel.receive_blocks ? channel.receive_timeout : 0;
}

bool Occurrences::never_overruns(std::uint32_t subsystem) const {
  const Time period = system_.subsystems[subsystem].period;
  return period == 0 || plus(responses_[subsystem].call, system_.latency) <= period;
}

bool Occurrences::keeps_values(std::uint32_t channel) const {
  const Channel& one = system_.channels[channel];
  return !one.send_blocks || one.send_timeout == 0 || never_fires_[events_.acked(channel)];
}
bool Occurrences::reads_new(std::uint32_t channel) const {
  const Channel& one = system_.channels[channel];
  return one.receive_blocks && (one.receive_timeout == 0 || never_fires_[events_.read(channel)]);
}
bool Occurrences::holds_on(EventId z) const {
  const std::uint32_t channel = events_[z].channel;
  if (events_[z].kind != Event::Kind::acked) return keeps_values(channel);
  // After a timeout, a value that is still on the way between processes may be read in place of the next one.
  return reads_new(channel) && (!system_.crosses(channel) || keeps_values(channel));
}

Time Occurrences::arrived(std::uint32_t channel, Time written) const {
  if (!system_.crosses(channel)) return written;
  const Time network = system_.channels[channel].network;
  return plus(std::max(written, network), network);
}

Occurrences::Wait Occurrences::wait_of(EventId z) const {
  const Event& event = events_[z];
  const bool waits = event.kind == Event::Kind::acked ||
                     (event.kind == Event::Kind::read && system_.channels[event.channel].receive_blocks);
  if (!waits) return Wait::none;
  if (timeout_of(z) > 0 && !never_fires_[z]) return Wait::timed;
  return holds_on(z) ? Wait::strict : Wait::lossy;
}
bool Occurrences::is_entry(EventId y) const {
  const Wait kind = wait_of(y);
  return kind == Wait::strict || (kind == Wait::timed && timed_as_strict_ && holds_on(y));
}
bool Occurrences::waits(std::uint32_t subsystem) const {
  for (EventId y = events_.start(subsystem); y <= events_.end(subsystem); ++y)
    if (wait_of(y) != Wait::none) return true;
  return false;
}

Time Occurrences::weight(EventId y) const {
  const Event& event = events_[y];
  if (event.kind == Event::Kind::finish)
    return plus(response(event.subsystem),
                system_.subsystems[event.subsystem].period > 0 ? system_.latency : 0);
  const Wait kind = wait_of(y);
  if (kind == Wait::lossy) return own_wait_[y];
  if (kind == Wait::timed && (!timed_as_strict_ || !holds_on(y))) return own_wait_[y];
  return 0;
}

Time Occurrences::least_between(EventId y, EventId x) const {
  const std::uint32_t subsystem = events_[x].subsystem;
  const Time period = system_.subsystems[subsystem].period, least = events_.least(x);
  if (period == 0 || begins_late(subsystem) || since_start_[y] >= unbounded) return least;
  return std::max(least, period + least - since_start_[y]);
}

// ------------------------------------------------------------------------------------------------- one assumption

void Occurrences::assume_and_judge() {
  // Each pass can only lower the bounds. In every other one, a wait whose timeout may fire is entered like a strict one.
  constexpr int passes = 6;
  const std::size_t size = events_.size(), subsystems = system_.subsystems.size();
  gap_.assign(size, unbounded);
  first_.assign(size, unbounded);
  since_start_.assign(size, unbounded);
  wait_.assign(size, 0);
  own_wait_.assign(size, 0);
  work_.assign(size, 0);
  held_up_.assign(size, false);
  periodic_.assign(subsystems, false);
  in_step_.assign(subsystems, -1);
  find_components();
  for (int pass = 0; pass < passes; ++pass) {
    timed_as_strict_ = pass % 2 == 1;
    for (Component& component : components_) {
      check(stop_);
      judge(component);
    }
  }
  for (EventId z = 0; z < size; ++z) wait_[z] = longest_wait(z);
}

void Occurrences::find_components() {
  std::vector<std::vector<EventId>> successors(events_.size());
  for (EventId y = 0; y < events_.size(); ++y) {
    for (const EventId z : events_[y].before) successors[z].push_back(y);
    const Wait kind = wait_of(y);
    if (kind == Wait::strict || kind == Wait::lossy) successors[partner_of(y)].push_back(y);
  }
  for (std::uint32_t i = 0; i < system_.subsystems.size(); ++i)
    successors[events_.end(i)].push_back(events_.start(i));
  components_.clear();
  component_of_.assign(events_.size(), 0);
  place_in_.assign(events_.size(), 0);
  for (std::vector<EventId>& events : components_of(successors)) {
    Component component;
    component.events = std::move(events);
    for (std::uint32_t place = 0; place < component.events.size(); ++place) {
      const EventId x = component.events[place];
      component_of_[x] = static_cast<std::uint32_t>(components_.size());
      place_in_[x] = place;
      if (events_[x].kind == Event::Kind::start) component.subsystems.push_back(events_[x].subsystem);
    }
    components_.push_back(std::move(component));
  }
}

void Occurrences::judge(Component& component) {
  bound_own_waits(component);
  measure_work(component);
  const bool dead = find_first(component);  // some events never occur: nothing bounds the others
  if (!dead) Rows(*this, component).find();
  for (const EventId x : component.events) {
    const EventId release = events_.start(events_[x].subsystem);
    since_start_[x] = std::min(since_start_[x], x == release ? 0 : span(release, x));
  }
  if (!dead) keep_step(component);
  find_periodic(component);
}

/// A lossy wait for an event of its own component never gets a bound: that event has none at first, so that z has none,
/// nor has the component.
void Occurrences::bound_own_waits(const Component& component) {
  for (const EventId z : component.events) {
    const Wait kind = wait_of(z);
    if (kind != Wait::lossy && kind != Wait::timed) continue;
    const EventId partner = partner_of(z);
    const std::uint32_t channel = events_[z].channel;
    const bool crosses = system_.crosses(channel);
    Time most = plus(std::max(gap_[partner], first_of_partner(z)), on_the_way(z));
    if (crosses && events_[z].kind == Event::Kind::acked) {
      // There, then the first receive, and back.
      const EventId write = events_.write(channel);
      const Time there = arrived(channel, events_.least(write)) - events_.least(write);
      most = plus(std::max(plus(there, gap_[partner]), first_[partner]), on_the_way(z));
    }
    // A value that is taken back before its reader is awake is missed. Between processes, several may be.
    if (events_[z].kind == Event::Kind::read && !holds_on(z) &&
        (crosses || system_.channels[channel].send_timeout <= wake_up(z)))
      most = unbounded;
    if (crosses && events_[z].kind == Event::Kind::acked && !keeps_values(channel)) most = unbounded;
    if (kind == Wait::timed) most = std::min(most, timeout_of(z));
    own_wait_[z] = plus(most, wake_up(z));
  }
}

/// work_: from the release to the event, waits for others left out. held_up_: one of them may come before it.
void Occurrences::measure_work(const Component& component) {
  for (const std::uint32_t i : component.subsystems)
    for (EventId y = events_.start(i); y <= events_.end(i); ++y) {
      work_[y] = 0;
      held_up_[y] = is_entry(y);
      for (const EventId z : events_[y].before) {
        work_[y] = std::max(work_[y], work_[z]);
        held_up_[y] = held_up_[y] || held_up_[z];
      }
      work_[y] = plus(work_[y], weight(y));
    }
}

/// true: some events never occur.
bool Occurrences::find_first(const Component& component) {
  std::vector<Time> found(component.events.size(), unbounded);
  std::vector<bool> seen(component.events.size());
  const auto at = [&](EventId y) {
    return same_component(y, component.events.front()) ? found[place_in_[y]] : first_[y];
  };
  const auto predecessors = [&](EventId y, std::vector<EventId>& list) {
    for (const EventId z : events_[y].before) list.push_back(z);
    if (wait_of(y) == Wait::strict && same_component(partner_of(y), y)) list.push_back(partner_of(y));
  };
  const auto visit = [&](EventId y) {
    Time before = 0;
    for (const EventId z : events_[y].before) before = std::max(before, at(z));
    Time late = plus(before, events_[y].kind == Event::Kind::start ? begin(events_[y].subsystem) : weight(y));
    const Wait kind = wait_of(y);
    if (kind == Wait::strict) {
      const Time other = at(partner_of(y));
      const bool reads = events_[y].kind == Event::Kind::read;
      late = std::max(
          late, plus(reads ? arrived(events_[y].channel, other) : plus(other, on_the_way(y)), wake_up(y)));
    }
    if (kind == Wait::timed) late = plus(before, own_wait_[y]);
    found[place_in_[y]] = late;
  };
  for (const EventId y : component.events)
    visit_in_order(
        y, seen, [&](EventId z) { return place_in_[z]; }, predecessors, visit);
  bool dead = false;
  for (const EventId y : component.events) {
    const Time late = found[place_in_[y]];
    first_[y] = std::min(first_[y], late);
    dead = dead || late >= unbounded;
  }
  return dead;
}

/// Subsystems of one period that wait only for each other: all releases come together, and what one round needs from
/// the first release is what every round needs.
void Occurrences::keep_step(const Component& component) {
  const Time period = system_.subsystems[component.subsystems.front()].period;
  if (period == 0) return;
  for (const std::uint32_t i : component.subsystems) {
    if (system_.subsystems[i].period != period) return;
    if (system_.subsystems[i].process != system_.subsystems[component.subsystems.front()].process) return;
  }
  std::vector<Time> found(component.events.size(), unbounded);
  std::vector<bool> seen(component.events.size());
  const auto predecessors = [&](EventId y, std::vector<EventId>& list) {
    for (const EventId z : events_[y].before) list.push_back(z);
    if (is_entry(y) && same_component(partner_of(y), y)) list.push_back(partner_of(y));
  };
  const auto visit = [&](EventId y) {
    Time before = 0;
    for (const EventId z : events_[y].before) before = std::max(before, found[place_in_[z]]);
    Time late = plus(before, events_[y].kind == Event::Kind::start ? 0 : weight(y));
    if (is_entry(y)) {
      const EventId partner = partner_of(y);
      const Time other = same_component(partner, y) ? found[place_in_[partner]]
                                                    : std::max(gap_[partner], first_of_partner(y));
      Time held = plus(plus(other, on_the_way(y)), wake_up(y));
      if (wait_of(y) == Wait::timed) held = std::min(held, plus(before, own_wait_[y]));
      late = std::max(late, held);
    }
    found[place_in_[y]] = late;
  };
  for (const EventId y : component.events)
    visit_in_order(
        y, seen, [&](EventId z) { return place_in_[z]; }, predecessors, visit);
  for (const EventId y : component.events) {
    const Event& event = events_[y];
    if (event.kind == Event::Kind::end && found[place_in_[y]] > period) return;
    if (event.kind != Event::Kind::read || !is_entry(y)) continue;
    // A send of the next round must not come before the receive of this one.
    const EventId write = partner_of(y);
    const bool may_overwrite = !system_.channels[event.channel].send_blocks;
    if (same_component(write, y) && may_overwrite && found[place_in_[y]] >= period + events_.least(write))
      return;
  }
  for (const EventId y : component.events) {
    since_start_[y] = std::min(since_start_[y], found[place_in_[y]]);
    in_step_[events_[y].subsystem] = component_of_[y];
  }
}

void Occurrences::find_periodic(const Component& component) {
  for (const std::uint32_t i : component.subsystems) {
    const Time period = system_.subsystems[i].period;
    const EventId release = events_.start(i);
    if (period > 0 && since_start_[events_.end(i)] <= period) periodic_[i] = true;
    if (periodic_[i]) {
      for (EventId x = release; x <= events_.end(i); ++x) {
        gap_[x] =
            x == release ? period : std::min(gap_[x], plus(period, minus(since_start_[x], events_.least(x))));
        first_[x] = std::min(first_[x], since_start_[x]);
      }
    } else if (period > 0 && gap_[release] < unbounded && !begins_late(i)) {
      gap_[release] = std::max(period, gap_[release] / period * period);
    }
    for (EventId x = release; x <= events_.end(i); ++x)
      gap_[x] = std::min(gap_[x], plus(gap_[release], minus(since_start_[x], events_.least(x))));
  }
}

Time Occurrences::longest_wait(EventId z) const {
  const Wait kind = wait_of(z);
  if (kind == Wait::none) return 0;
  if (kind != Wait::strict) return own_wait_[z];
  const EventId partner = partner_of(z), before = events_[z].before.front();
  Time earliest = events_.least(before);
  for (const EventId y : events_[z].before) earliest = std::max(earliest, events_.least(y));
  const Time next = same_component(partner, z) ? std::min(span(z, partner), gap_[partner]) : gap_[partner];
  Time most = plus(std::max(minus(next, least_between(z, before)), minus(first_of_partner(z), earliest)),
                   on_the_way(z));
  if (periodic_[events_[z].subsystem])
    most = std::min(most, minus(minus(since_start_[z], earliest), wake_up(z)));
  return std::max<Time>(most, 0);
}

}  // namespace tessera::timing
