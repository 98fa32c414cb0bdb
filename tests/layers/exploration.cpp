#include "layers/exploration.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>

namespace tessera::test {
namespace {

using Successors = std::function<std::vector<Marking>(const Marking&)>;

Exploration breadth_first(const Marking& start, std::size_t limit, const Successors& successors) {
  Exploration found;
  found.markings.insert(start);
  std::queue<Marking> open;
  open.push(start);
  for (; !open.empty(); open.pop())
    for (Marking& next : successors(open.front())) {
      if (!found.markings.insert(next).second) continue;
      if (found.markings.size() >= limit) {
        found.complete = false;
        return found;
      }
      open.push(std::move(next));
    }
  return found;
}

/// The token game on the drawn nets. A fused place is one counter; pages have none: what enters a page enters
/// the input place of its net.
class DrawnGame {
 public:
  explicit DrawnGame(const net::HierarchicalNet& net) : net_(net) {
    std::uint32_t nodes = static_cast<std::uint32_t>(net.fusions.size());
    for (const net::Page& page : net.pages) {
      first_.push_back(nodes);
      nodes += static_cast<std::uint32_t>(page.nodes.size());
    }
    start_.assign(nodes, 0);
    for (std::uint32_t page = 0; page < net.pages.size(); ++page)
      for (std::uint32_t node = 0; node < net.pages[page].nodes.size(); ++node)
        counter(start_, {page, node}, &net::Page::input) = net.pages[page].nodes[node].tokens;
  }

  [[nodiscard]] const Marking& start() const { return start_; }

  [[nodiscard]] std::vector<Marking> successors(const Marking& marking) const {
    std::vector<Marking> all;
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page)
      for (const net::PageTransition& transition : net_.pages[page].transitions)
        if (auto next = fire(marking, page, transition)) all.push_back(std::move(*next));
    return all;
  }

  [[nodiscard]] std::set<std::string> marked(const Marking& marking) const {
    std::set<std::string> names;
    const auto add = [&](std::uint32_t at, const std::string& name) {
      if (marking[at] > 0) names.insert(marking[at] == 1 ? name : name + "*" + std::to_string(marking[at]));
    };
    for (std::uint32_t set = 0; set < net_.fusions.size(); ++set) add(set, net_.fusions[set].name);
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page)
      for (std::uint32_t node = 0; node < net_.pages[page].nodes.size(); ++node) {
        const std::string path = net_.path(net::PageId{page});
        add(first_[page] + node, (path.empty() ? "" : path + ".") + net_.pages[page].nodes[node].name);
      }
    return names;
  }

 private:
  struct At {
    std::uint32_t page, node;
  };

  std::uint32_t& counter(Marking& marking, At at, std::uint32_t net::Page::*port) const {
    const net::Node& node = net_.pages[at.page].nodes[at.node];
    if (node.fusion.valid()) return marking[node.fusion.value];
    if (!node.page.valid()) return marking[first_[at.page] + at.node];
    return counter(marking, {node.page.value, net_.pages[node.page.value].*port}, port);
  }

  [[nodiscard]] std::optional<Marking> fire(const Marking& marking, std::uint32_t page,
                                            const net::PageTransition& transition) const {
    Marking next = marking;
    for (const std::uint32_t input : transition.inputs) {
      std::uint32_t& tokens = counter(next, {page, input}, &net::Page::output);
      if (tokens == 0) return std::nullopt;
      --tokens;
    }
    for (const std::uint32_t output : transition.outputs) ++counter(next, {page, output}, &net::Page::input);
    return next;
  }

  const net::HierarchicalNet& net_;
  std::vector<std::uint32_t> first_;  // per page
  Marking start_;
};

}  // namespace

Exploration explore(const net::Net& net, std::size_t limit) {
  Marking start;
  for (const net::Place& place : net.places()) start.push_back(place.tokens);
  return breadth_first(start, limit, [&](const Marking& marking) {
    std::vector<Marking> all;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      const net::TransitionId id{index};
      const auto has = [&](const net::Arc& arc) { return marking[arc.place.value] >= arc.weight; };
      if (!std::ranges::all_of(net.preset(id), has)) continue;
      Marking next = marking;
      for (const net::Arc& arc : net.preset(id)) next[arc.place.value] -= arc.weight;
      for (const net::Arc& arc : net.postset(id)) next[arc.place.value] += arc.weight;
      all.push_back(std::move(next));
    }
    return all;
  });
}

Exploration explore(const net::HierarchicalNet& net, std::size_t limit) {
  const DrawnGame game(net);
  return breadth_first(game.start(), limit, [&](const Marking& marking) { return game.successors(marking); });
}

std::set<std::string> marked(const net::Net& net, const Marking& marking) {
  std::set<std::string> names;
  for (std::uint32_t place = 0; place < marking.size(); ++place)
    if (marking[place] > 0)
      names.insert(net.places()[place].name +
                   (marking[place] == 1 ? "" : "*" + std::to_string(marking[place])));
  return names;
}

std::set<std::string> marked(const net::HierarchicalNet& net, const Marking& marking) {
  return DrawnGame(net).marked(marking);
}

}  // namespace tessera::test
