// Two walks through a graph of events, without recursion: fleets make long paths.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/events.hpp"

namespace tessera::timing {

/// The strongly connected components of a graph, each before those that its edges lead to.
/// successors: per event.
/// Source: Tarjan, SIAM J. Comput. 1(2), 1972.
[[nodiscard]] std::vector<std::vector<EventId>> components_of(
    const std::vector<std::vector<EventId>>& successors);

/// Visits `from` and all events that it depends on, each one after those that it depends on. On a circle, an event is
/// visited although one that it depends on is not.
/// seen: by place; events that were visited before are left out. place(event) is its index there.
/// predecessors(event, list): appends what the event depends on. visit(event): once for each.
template <class Place, class Predecessors, class Visit>
void visit_in_order(EventId from, std::vector<bool>& seen, Place place, Predecessors predecessors,
                    Visit visit) {
  struct Frame {
    EventId event;
    std::size_t begin, next;  ///< into `waiting`
  };
  std::vector<EventId> waiting;
  std::vector<Frame> path;
  const auto enter = [&](EventId event) {
    if (seen[place(event)]) return;
    seen[place(event)] = true;
    path.push_back({event, waiting.size(), waiting.size()});
    predecessors(event, waiting);
  };
  enter(from);
  while (!path.empty()) {
    Frame& top = path.back();
    if (top.next < waiting.size()) {
      enter(waiting[top.next++]);
      continue;
    }
    visit(top.event);
    waiting.resize(top.begin);
    path.pop_back();
  }
}

}  // namespace tessera::timing
