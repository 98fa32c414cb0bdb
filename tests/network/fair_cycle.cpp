#include "fair_cycle.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace tessera::test {
namespace {

using Edge = FairGraph::Edge;
using Kind = FairGraph::Kind;
using Nodes = std::vector<std::uint32_t>;
using Messages = std::set<std::uint32_t>;

constexpr std::uint32_t unseen = UINT32_MAX;

/// Streett's condition, component by component: a message that is sent in a component but never arrives there
/// may be sent only finitely often, so the component is looked at again without those steps.
class Search {
 public:
  explicit Search(const FairGraph& graph)
      : graph_(graph),
        member_(graph.edges.size(), 0),
        number_(member_.size()),
        low_(member_.size()),
        open_(member_.size()) {}

  bool finds(const Nodes& within, const Messages& banned) {
    const std::uint32_t mark = ++marks_;
    for (const std::uint32_t node : within) {
      member_[node] = mark;
      number_[node] = unseen;
    }
    std::vector<Nodes> components = components_of(within, mark, banned);
    for (const Nodes& component : components)
      if (is_fair(component, banned)) return true;
    return false;
  }

 private:
  static bool allowed(const Edge& edge, const Messages& banned) {
    if (edge.kind == Kind::restart || edge.kind == Kind::time_up) return false;
    return !banned.contains(edge.sent) && !banned.contains(edge.answered);
  }

  std::vector<Nodes> components_of(const Nodes& within, std::uint32_t mark, const Messages& banned) {
    std::vector<Nodes> found;
    std::uint32_t count = 0;
    Nodes stack;
    std::vector<std::pair<std::uint32_t, std::size_t>> calls;
    const auto enter = [&](std::uint32_t node) {
      number_[node] = low_[node] = count++;
      open_[node] = 1;
      stack.push_back(node);
      calls.emplace_back(node, 0);
    };
    for (const std::uint32_t root : within) {
      if (number_[root] != unseen) continue;
      enter(root);
      while (!calls.empty()) {
        const std::uint32_t node = calls.back().first;
        if (calls.back().second < graph_.edges[node].size()) {
          const Edge& edge = graph_.edges[node][calls.back().second++];
          if (member_[edge.to] != mark || !allowed(edge, banned)) continue;
          if (number_[edge.to] == unseen)
            enter(edge.to);
          else if (open_[edge.to] != 0)
            low_[node] = std::min(low_[node], number_[edge.to]);
          continue;
        }
        calls.pop_back();
        if (!calls.empty()) low_[calls.back().first] = std::min(low_[calls.back().first], low_[node]);
        if (low_[node] != number_[node]) continue;
        Nodes& component = found.emplace_back();
        do {
          component.push_back(stack.back());
          open_[stack.back()] = 0;
          stack.pop_back();
        } while (component.back() != node);
      }
    }
    return found;
  }

  bool is_fair(const Nodes& component, const Messages& banned) {
    const std::uint32_t mark = ++marks_;
    for (const std::uint32_t node : component) member_[node] = mark;
    bool cycle = false, reads = false, repeats = false, hello = false;
    bool pending = true, full = true, alone = true;
    Messages sent, arrived;
    for (const std::uint32_t node : component) {
      pending = pending && graph_.marks[node].pending;
      full = full && graph_.marks[node].full;
      alone = alone && graph_.marks[node].alone;
      for (const Edge& edge : graph_.edges[node]) {
        if (member_[edge.to] != mark || !allowed(edge, banned)) continue;
        cycle = true;
        reads = reads || edge.kind == Kind::read;
        repeats = repeats || edge.kind == Kind::repeat;
        hello = hello || edge.kind == Kind::hello;
        for (const std::uint32_t message : {edge.sent, edge.answered})
          if (message != FairGraph::no_message) sent.insert(message);
        if (edge.got != FairGraph::no_message) arrived.insert(edge.got);
      }
    }
    if ((pending && !repeats) || (full && !reads) || (alone && !hello)) return false;
    if (!cycle) return rests(component.front());
    Messages more = banned;
    for (const std::uint32_t message : sent)
      if (!arrived.contains(message)) more.insert(message);
    return more.size() == banned.size() || finds(component, more);
  }

  /// Only optional actions of users are left.
  [[nodiscard]] bool rests(std::uint32_t node) const {
    return std::ranges::all_of(graph_.edges[node], [](const Edge& edge) {
      return edge.kind == Kind::user || edge.kind == Kind::time_up || edge.kind == Kind::restart ||
             edge.kind == Kind::loss;
    });
  }

  const FairGraph& graph_;
  std::uint32_t marks_ = 0;
  std::vector<std::uint32_t> member_;  // per node: the last set that it was in
  std::vector<std::uint32_t> number_, low_;
  std::vector<char> open_;
};

}  // namespace

bool has_fair_cycle(const FairGraph& graph, const std::vector<std::uint32_t>& within) {
  return Search(graph).finds(within, {});
}

}  // namespace tessera::test
