#include "verify/circuits/event_graph.hpp"

#include <algorithm>
#include <deque>
#include <optional>

namespace tessera::verify {
namespace {

/// Tarjan's algorithm with its own stack, since the rings of a fleet are longer than a thread's
/// stack is deep.
class Tarjan {
 public:
  Tarjan(const EventGraph& graph, const EventGraph::Filter& filter)
      : graph_(graph),
        filter_(filter),
        number_(graph.size()),
        low_(graph.size(), 0),
        component_(graph.size(), 0),
        closed_(graph.size(), false) {}

  std::vector<std::uint32_t> result() {
    for (std::uint32_t root = 0; root < graph_.size(); ++root)
      if (!number_[root]) visit(root);
    return std::move(component_);
  }

 private:
  struct Frame {
    std::uint32_t node;
    std::size_t next = 0;  // edge to look at
  };

  void enter(std::uint32_t node) {
    low_[node] = count_++;
    number_[node] = low_[node];
    open_.push_back(node);
    calls_.push_back({node});
  }

  void visit(std::uint32_t root) {
    enter(root);
    while (!calls_.empty()) {
      Frame& frame = calls_.back();
      const auto edges = graph_.from(frame.node);
      if (frame.next == edges.size()) {
        leave();
        continue;
      }
      const EventGraph::Edge& edge = edges[frame.next++];
      if (!filter_(edge)) continue;
      if (!number_[edge.to])
        enter(edge.to);
      else if (!closed_[edge.to])
        low_[frame.node] = std::min(low_[frame.node], *number_[edge.to]);
    }
  }

  void leave() {
    const std::uint32_t node = calls_.back().node;
    calls_.pop_back();
    if (!calls_.empty()) low_[calls_.back().node] = std::min(low_[calls_.back().node], low_[node]);
    if (low_[node] != number_[node]) return;
    for (bool more = true; more;) {
      more = open_.back() != node;
      component_[open_.back()] = components_;
      closed_[open_.back()] = true;
      open_.pop_back();
    }
    ++components_;
  }

  const EventGraph& graph_;
  const EventGraph::Filter& filter_;
  std::vector<std::optional<std::uint32_t>> number_;  // nullopt: not seen yet
  std::vector<std::uint32_t> low_, component_;
  std::vector<bool> closed_;  // its component is known
  std::vector<std::uint32_t> open_;
  std::vector<Frame> calls_;
  std::uint32_t count_ = 0, components_ = 0;
};

}  // namespace

std::uint32_t EventGraph::node(SubsystemFlowId subsystem) {
  subsystem_.push_back(subsystem);
  return static_cast<std::uint32_t>(subsystem_.size() - 1);
}

void EventGraph::close() {
  std::ranges::stable_sort(edges_, {}, &Edge::from);
  starts_.assign(size() + 1, 0);
  for (const Edge& edge : edges_) ++starts_[edge.from + 1];
  for (std::size_t node = 0; node < size(); ++node) starts_[node + 1] += starts_[node];
}

std::vector<std::uint32_t> EventGraph::components(const Filter& filter) const {
  return Tarjan(*this, filter).result();
}

std::vector<bool> EventGraph::reached(const std::vector<std::uint32_t>& sources) const {
  std::vector<bool> seen(size(), false);
  std::vector<std::uint32_t> open = sources;
  for (const std::uint32_t node : sources) seen[node] = true;
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    for (const Edge& edge : from(node)) {
      if (seen[edge.to]) continue;
      seen[edge.to] = true;
      open.push_back(edge.to);
    }
  }
  return seen;
}

std::vector<EventGraph::Edge> EventGraph::path(std::uint32_t start, std::uint32_t goal,
                                               const Filter& filter) const {
  std::vector<const Edge*> entered_by(size(), nullptr);
  std::deque<std::uint32_t> open{start};
  while (!open.empty() && entered_by[goal] == nullptr) {
    const std::uint32_t node = open.front();
    open.pop_front();
    for (const Edge& edge : from(node)) {
      if (!filter(edge) || edge.to == start || entered_by[edge.to] != nullptr) continue;
      entered_by[edge.to] = &edge;
      open.push_back(edge.to);
    }
  }
  std::vector<Edge> edges;
  for (std::uint32_t node = goal; node != start && entered_by[node] != nullptr; node = entered_by[node]->from)
    edges.push_back(*entered_by[node]);
  std::ranges::reverse(edges);
  return edges;
}

}  // namespace tessera::verify
