// LineGraph: computes the way of the robot from the pieces of a line.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/line_graph.hpp"

namespace tessera::sim {
namespace {

constexpr double longest_gap_m = 0.06;

double angle_between(const Point& a, const Point& b) {
  return std::acos(std::clamp(a.x_m * b.x_m + a.y_m * b.y_m, -1.0, 1.0));
}

Point opposite(const Point& p) { return {-p.x_m, -p.y_m}; }

}  // namespace

void LineGraph::bridge_gaps() {
  struct Bridge {
    double cost;
    Port from, to;
  };
  std::vector<Port> free_ends;
  for (const auto& there : ports()) {
    if (there.size() == 1) free_ends.push_back(there.front());
  }
  std::vector<Bridge> bridges;
  // Thinning shortens each end by half the width of the line.
  const double reach = longest_gap_m + 1.2 * width_m_;
  for (std::size_t i = 0; i < free_ends.size(); ++i) {
    for (std::size_t j = i + 1; j < free_ends.size(); ++j) {
      const Port& from = free_ends[i];
      const Port& to = free_ends[j];
      const double dx = position_of(to).x_m - position_of(from).x_m;
      const double dy = position_of(to).y_m - position_of(from).y_m;
      const double gap = std::hypot(dx, dy);
      if (gap > reach || gap < 1e-9) continue;
      if (from.edge == to.edge && length_of(edges_[from.edge].points) < 4 * gap) continue;
      const Point across{dx / gap, dy / gap};
      const double bend =
          std::max(angle_between(opposite(direction(from)), across), angle_between(direction(to), across));
      if (bend < std::numbers::pi / 3) bridges.push_back({gap * (1 + bend), from, to});
    }
  }
  std::ranges::stable_sort(bridges, {}, &Bridge::cost);
  std::vector<Port> joined;
  for (const Bridge& bridge : bridges) {
    if (std::ranges::count(joined, bridge.from) + std::ranges::count(joined, bridge.to) > 0) continue;
    joined.insert(joined.end(), {bridge.from, bridge.to});
    edges_.push_back(
        {{edges_[bridge.from.edge].ends[bridge.from.end], edges_[bridge.to.edge].ends[bridge.to.end]},
         {position_of(bridge.from), position_of(bridge.to)}});
  }
  join_through_nodes();
}

void LineGraph::keep_loops() {
  LineGraph loops = *this;
  for (bool changed = true; changed;) {
    const auto at = loops.ports();
    std::vector<std::size_t> dead_ends;
    for (std::size_t e = 0; e < loops.edges_.size(); ++e) {
      const auto& ends = loops.edges_[e].ends;
      if (at[ends[0]].size() == 1 || at[ends[1]].size() == 1) dead_ends.push_back(e);
    }
    changed = !dead_ends.empty();
    loops.drop(std::move(dead_ends));
  }
  const auto total = [](const LineGraph& graph) {
    double sum = 0;
    for (const Edge& edge : graph.edges_) sum += length_of(edge.points);
    return sum;
  };
  if (total(loops) < 0.25 * total(*this)) return;
  loops.join_through_nodes();
  *this = std::move(loops);
}

LineGraph::Partners LineGraph::straight_partners() const {
  struct Pair {
    double bend;
    Port a, b;
  };
  Partners partners(edges_.size());
  for (const auto& there : ports()) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < there.size(); ++i) {
      for (std::size_t j = i + 1; j < there.size(); ++j) {
        pairs.push_back(
            {angle_between(opposite(direction(there[i])), direction(there[j])), there[i], there[j]});
      }
    }
    std::ranges::stable_sort(pairs, {}, &Pair::bend);
    for (const Pair& pair : pairs) {
      auto& a = partners[pair.a.edge][pair.a.end];
      auto& b = partners[pair.b.edge][pair.b.end];
      if (a || b) continue;
      a = pair.b;
      b = pair.a;
    }
  }
  return partners;
}

/// Depth-first search over simple cycles. It gives up after more steps than any drawn track needs.
LineGraph::Way LineGraph::longest_cycle() const {
  const auto at = ports();
  std::vector<bool> visited(nodes_);
  Way way{.edges = {}, .closed = true};
  Way longest = way;
  double length = 0;
  double longest_m = 0;
  int steps = 200'000;
  const auto go_on = [&](const auto& self, std::size_t start, std::size_t node) -> void {
    for (const Port& port : at[node]) {
      if (--steps < 0) return;
      const std::size_t next = edges_[port.edge].ends[1 - port.end];
      const bool back_on_it = !way.edges.empty() && way.edges.back().edge == port.edge;
      if (back_on_it || next < start || (visited[next] && next != start)) continue;
      const double edge_m = length_of(edges_[port.edge].points);
      way.edges.push_back(port);
      length += edge_m;
      if (next == start && length > longest_m) {
        longest = way;
        longest_m = length;
      } else if (next != start) {
        visited[next] = true;
        self(self, start, next);
        visited[next] = false;
      }
      way.edges.pop_back();
      length -= edge_m;
    }
  };
  for (std::size_t start = 0; start < nodes_; ++start) go_on(go_on, start, start);
  return longest;
}

Skeleton LineGraph::longest_way() const {
  if (edges_.empty()) return {};
  const auto all = ways(straight_partners());
  const auto length = [&](const Way& way) { return length_of(points_of(way)); };
  const auto longest = [&](bool closed) {
    Way best;
    for (const Way& way : all) {
      if (way.closed == closed && (best.edges.empty() || length(way) > length(best))) best = way;
    }
    return best;
  };
  const Way open = longest(false);
  Way way = longest(true);
  if (way.edges.empty() || length(way) < 0.5 * length(open)) {
    const Way cycle = longest_cycle();
    if (length(cycle) > length(way)) way = cycle;
  }
  if (length(way) < 0.25 * length(open)) way = open;
  return {points_of(way), way.closed};
}

}  // namespace tessera::sim
