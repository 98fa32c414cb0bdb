#include "timing/rows.hpp"

#include <algorithm>
#include <limits>

#include "timing/graph.hpp"

namespace tessera::timing {
namespace {
/// Rows of a larger component would take too long: the number of its events, squared.
constexpr std::size_t most_events = 1500;
}  // namespace

void Rows::find() {
  const std::vector<EventId>& events = component_.events;
  const bool small = events.size() <= most_events;
  const auto lower_gap = [&](EventId x) { bounds_.gap_[x] = std::min(bounds_.gap_[x], bounds_.span(x, x)); };
  if (!small || !counts_are_fixed()) {
    component_.everything = std::min(component_.everything, all_work());
    for (std::vector<Time>& row : component_.rows)
      for (Time& span : row) span = std::min(span, component_.everything);
    std::ranges::for_each(events, lower_gap);
    return;
  }
  if (component_.rows.empty())
    component_.rows.assign(events.size(), std::vector<Time>(events.size(), component_.everything));
  for (std::size_t place = 0; place < events.size(); ++place) {
    find_row(events[place], component_.rows[place]);
    lower_gap(events[place]);  // the next rows use it
  }
}

/// Fewest tokens on the paths from each event of the component to x.
void Rows::count_tokens_to(EventId x) {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  tokens_.assign(component_.events.size(), none);
  std::vector<EventId> level{x}, next;
  tokens_[bounds_.place_in_[x]] = 0;
  for (std::uint32_t count = 0; !level.empty(); ++count) {
    for (std::size_t at = 0; at < level.size(); ++at) {
      const EventId y = level[at];
      if (tokens(y) != count) continue;
      const auto reach = [&](EventId z, bool has_token) {
        const std::uint32_t there = count + (has_token ? 1 : 0);
        if (!is_mine(z) || tokens(z) <= there) return;
        tokens_[bounds_.place_in_[z]] = there;
        (has_token ? next : level).push_back(z);
      };
      const Event& event = bounds_.events_[y];
      for (const EventId z : event.before) reach(z, false);
      if (event.kind == Event::Kind::start) reach(bounds_.events_.end(event.subsystem), true);
      if (bounds_.wait_of(y) == Occurrences::Wait::strict) reach(bounds_.partner_of(y), false);
    }
    level.swap(next);
    next.clear();
  }
}

/// No send within the component overwrites: each channel in it is on a circuit with one token, or blocks at both ends.
bool Rows::counts_are_fixed() {
  using Wait = Occurrences::Wait;
  for (const EventId y : component_.events) {
    const Event& event = bounds_.events_[y];
    if (event.kind != Event::Kind::read || bounds_.wait_of(y) != Wait::strict) continue;
    const EventId write = bounds_.events_.write(event.channel);
    if (!is_mine(write)) continue;
    if (bounds_.system_.channels[event.channel].send_blocks &&
        bounds_.wait_of(bounds_.events_.acked(event.channel)) == Wait::strict)
      continue;
    check(bounds_.stop_);
    count_tokens_to(write);
    if (tokens(y) != 1) return false;
  }
  return true;
}

/// Each event of a critical path occurs once in it, so that it is never longer than all the work there is.
Time Rows::all_work() const {
  Time sum = 0, most = 0, enter = 0;
  for (const EventId y : component_.events) {
    const Event& event = bounds_.events_[y];
    if (event.kind == Event::Kind::start) {
      const Time own = bounds_.work_[bounds_.events_.end(event.subsystem)];
      sum = plus(sum, plus(own, bounds_.system_.subsystems[event.subsystem].period));
      most = std::max(most, own);
    }
    if (!bounds_.is_entry(y)) continue;
    sum = plus(sum, plus(bounds_.wake_up(y), bounds_.on_the_way(y)));
    const EventId partner = bounds_.partner_of(y);
    if (!is_mine(partner) || bounds_.wait_of(y) == Occurrences::Wait::timed)
      enter = std::max(enter, std::max(bounds_.gap(partner), bounds_.first_of_partner(y)));
  }
  return plus(plus(sum, most), enter);
}

/// The latest that the first b after the last y (an event that waits for it) can be, counted from x, if it is not on
/// the way for longer than later ones. around: that last y lies in an iteration before that of x.
Time Rows::occurrence(EventId b, EventId y, EventId x, bool around) const {
  const Events& events = bounds_.events_;
  const bool own = events[x].subsystem == events[y].subsystem;
  const Time ago = own && around ? bounds_.least_between(y, x) : 0;
  return std::max(minus(bounds_.gap(b), ago), minus(bounds_.first_of_partner(y), events.least(x)));
}

void Rows::find_row(EventId x, std::vector<Time>& row) {
  const Events& events = bounds_.events_;
  check(bounds_.stop_);
  count_tokens_to(x);
  latest_.assign(component_.events.size(), {unbounded, unbounded});
  std::vector<bool> seen(component_.events.size());
  const auto place = [&](EventId y) { return bounds_.place_in_[y]; };
  // Other edges lead to occurrences that are not later than x.
  const auto predecessors = [&](EventId y, std::vector<EventId>& list) {
    if (events[y].kind == Event::Kind::start) {
      const EventId end = events.end(events[y].subsystem);
      if (tokens(end) == tokens(y) + 1) list.push_back(end);
      return;
    }
    for (const EventId z : events[y].before)
      if (tokens(z) == tokens(y)) list.push_back(z);
    if (bounds_.wait_of(y) != Occurrences::Wait::strict) return;
    const EventId partner = bounds_.partner_of(y);
    if (is_mine(partner) && tokens(partner) == tokens(y)) list.push_back(partner);
  };
  const auto visit = [&](EventId y) {
    Latest latest = events[y].kind == Event::Kind::start ? at_release(y, x) : at_event(y, x);
    // Whatever the path: an event occurs again within its gap.
    const Time most = std::max(bounds_.gap(y), minus(bounds_.first(y), events.least(x)));
    latest_[place(y)] = {std::min({latest.any, most, unbounded}), std::min({latest.held, most, unbounded})};
  };
  for (const EventId y : component_.events) {
    visit_in_order(y, seen, place, predecessors, visit);
    row[place(y)] = std::min(row[place(y)], latest_[place(y)].any);
  }
}

Rows::Latest Rows::at_release(EventId y, EventId x) const {
  const Events& events = bounds_.events_;
  const std::uint32_t i = events[y].subsystem;
  const EventId end = events.end(i);
  const Time period = bounds_.system_.subsystems[i].period;
  Latest last{0, bounds_.held_up_[end] ? 0 : never};
  if (tokens(end) == tokens(y) + 1) last = latest_[bounds_.place_in_[end]];
  if (period == 0) {
    const Time beginning = bounds_.begin(i) - events.least(x);  // of the first one, which no end comes before
    return {std::max(last.any, beginning), std::max(last.held, beginning)};
  }
  const Time ago = events[x].subsystem == i ? events.least(x) : 0;  // the release before
  const Time own = bounds_.work_[end], wait_for_grid = period - 1;
  Time on_grid = unbounded;
  if (bounds_.begins_late(i))
    on_grid = minus(std::max(period, bounds_.waits(i) ? plus(own, wait_for_grid) : own), ago);
  else if (own < unbounded)
    on_grid = period * std::max<Time>(1, ceil_div(own, period)) - ago;
  const Time after_wait = last.held <= never ? never : plus(last.held, wait_for_grid);
  const Time by_path = std::max(period - ago, plus(last.any, wait_for_grid));
  const Time late = std::min(std::max(on_grid, after_wait), by_path);
  return {late, late};
}

Rows::Latest Rows::at_event(EventId y, EventId x) const {
  Latest latest{never, never};
  for (const EventId z : bounds_.events_[y].before) {
    Latest last{0, bounds_.held_up_[z] ? 0 : never};
    if (tokens(z) == tokens(y)) last = latest_[bounds_.place_in_[z]];
    latest = {std::max(latest.any, last.any), std::max(latest.held, last.held)};
  }
  const Time before = latest.any, weight = bounds_.weight(y);
  latest.any = plus(before, weight);
  if (latest.held > never) latest.held = plus(latest.held, weight);
  if (!bounds_.is_entry(y)) return latest;
  const EventId partner = bounds_.partner_of(y);
  Time late = occurrence(partner, y, x, tokens(y) == 1);
  if (bounds_.wait_of(y) == Occurrences::Wait::strict && is_mine(partner)) {
    Time path = tokens(partner) == tokens(y) ? latest_[bounds_.place_in_[partner]].any : 0;
    // A value of the start leaves when the processes have heard each other.
    const Event& event = bounds_.events_[y];
    if (event.kind == Event::Kind::read && bounds_.system_.crosses(event.channel))
      path = std::max(path, bounds_.on_the_way(y) - bounds_.events_.least(x));
    late = std::min(late, path);
  }
  late = plus(late, plus(bounds_.on_the_way(y), bounds_.wake_up(y)));
  if (bounds_.wait_of(y) == Occurrences::Wait::timed)
    late = std::min(late, plus(before, bounds_.own_wait_[y]));
  return {std::max(latest.any, late), std::max(latest.held, late)};
}

}  // namespace tessera::timing
