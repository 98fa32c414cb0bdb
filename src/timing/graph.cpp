#include "timing/graph.hpp"

#include <algorithm>

namespace tessera::timing {

std::vector<std::vector<EventId>> components_of(const std::vector<std::vector<EventId>>& successors) {
  constexpr std::uint32_t unseen = 0;
  std::vector<std::uint32_t> index(successors.size(), unseen), low(successors.size());
  std::vector<bool> on_stack(successors.size());
  std::vector<EventId> stack;
  std::vector<std::vector<EventId>> components;
  struct Frame {
    EventId event;
    std::size_t next = 0;
  };
  std::vector<Frame> path;
  std::uint32_t count = unseen;
  const auto enter = [&](EventId event) {
    index[event] = low[event] = ++count;
    stack.push_back(event);
    on_stack[event] = true;
    path.push_back({event});
  };
  for (EventId root = 0; root < successors.size(); ++root) {
    if (index[root] != unseen) continue;
    enter(root);
    while (!path.empty()) {
      const EventId event = path.back().event;
      if (path.back().next < successors[event].size()) {
        const EventId next = successors[event][path.back().next++];
        if (index[next] == unseen)
          enter(next);
        else if (on_stack[next])
          low[event] = std::min(low[event], index[next]);
        continue;
      }
      path.pop_back();
      if (!path.empty()) low[path.back().event] = std::min(low[path.back().event], low[event]);
      if (low[event] != index[event]) continue;
      components.emplace_back();
      for (EventId last = event + 1; last != event;) {
        last = stack.back();
        stack.pop_back();
        on_stack[last] = false;
        components.back().push_back(last);
      }
    }
  }
  std::ranges::reverse(components);
  return components;
}

}  // namespace tessera::timing
