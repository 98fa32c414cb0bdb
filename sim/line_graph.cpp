#include "sim/line_graph.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace tessera::sim {
namespace {

/// Line pixels next to `pixel`; diagonal ones only where no line pixel lies between.
std::vector<std::size_t> linked(const Bitmap& b, std::size_t pixel) {
  const auto w = static_cast<std::size_t>(b.width);
  std::vector<std::size_t> found;
  for (const std::size_t p : {pixel + 1, pixel - 1, pixel + w, pixel - w}) {
    if (b.line[p] != 0) found.push_back(p);
  }
  for (const auto& [dx, dy] :
       std::initializer_list<std::pair<int, int>>{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
    const std::size_t beside = pixel + static_cast<std::size_t>(dx);
    const std::size_t above = pixel + static_cast<std::size_t>(dy) * w;
    if (b.line[above + static_cast<std::size_t>(dx)] != 0 && b.line[beside] == 0 && b.line[above] == 0) {
      found.push_back(above + static_cast<std::size_t>(dx));
    }
  }
  return found;
}

/// Follows the line's pixels from node to node.
class Tracer {
 public:
  explicit Tracer(const Bitmap& picture) : picture_(picture) {}

  std::vector<LineGraph::Edge> edges() {
    for (std::size_t p = 0; p < picture_.line.size(); ++p) {
      if (picture_.line[p] != 0 && linked(picture_, p).size() != 2) add_node(p);
    }
    const auto ends_and_junctions = nodes_;
    std::vector<std::size_t> pixels;
    for (const auto& [pixel, node] : ends_and_junctions) pixels.push_back(pixel);
    std::ranges::sort(pixels);
    for (const std::size_t pixel : pixels) trace_from(pixel);
    for (std::size_t p = 0; p < picture_.line.size(); ++p) {  // loops without a junction
      if (picture_.line[p] == 0 || passed_.contains(p) || nodes_.contains(p)) continue;
      add_node(p);
      trace_from(p);
    }
    return std::move(edges_);
  }
  [[nodiscard]] std::size_t nodes() const { return nodes_.size(); }

 private:
  void add_node(std::size_t pixel) { nodes_.emplace(pixel, nodes_.size()); }

  void trace_from(std::size_t start) {
    for (std::size_t pixel : linked(picture_, start)) {
      if (nodes_.contains(pixel) ? pixel < start : passed_.contains(pixel)) continue;
      LineGraph::Edge edge{.ends = {nodes_.at(start), 0}, .points = {picture_.centre_of(start)}};
      std::size_t before = start;
      while (!nodes_.contains(pixel)) {
        passed_.insert(pixel);
        edge.points.push_back(picture_.centre_of(pixel));
        const auto next = linked(picture_, pixel);
        const std::size_t on = next[0] == before ? next[1] : next[0];
        before = pixel;
        pixel = on;
      }
      edge.points.push_back(picture_.centre_of(pixel));
      edge.ends[1] = nodes_.at(pixel);
      edges_.push_back(std::move(edge));
    }
  }

  const Bitmap& picture_;
  std::unordered_map<std::size_t, std::size_t> nodes_;  ///< by pixel
  std::unordered_set<std::size_t> passed_;              ///< pixels between nodes
  std::vector<LineGraph::Edge> edges_;
};

}  // namespace

double length_of(const std::vector<Point>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += distance(points[i - 1], points[i]);
  return length;
}

LineGraph::LineGraph(const Bitmap& thinned, double line_width_m) : width_m_(line_width_m) {
  Tracer tracer(thinned);
  edges_ = tracer.edges();
  nodes_ = tracer.nodes();
}

std::vector<std::vector<LineGraph::Port>> LineGraph::ports() const {
  std::vector<std::vector<Port>> at(nodes_);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
      at[edges_[e].ends[end]].push_back({e, end});
  }
  return at;
}

const Point& LineGraph::position_of(const Port& port) const {
  const auto& points = edges_[port.edge].points;
  return port.end == 0 ? points.front() : points.back();
}

Point LineGraph::direction(const Port& port) const {
  const auto& points = edges_[port.edge].points;
  const auto at = [&](std::size_t i) { return port.end == 0 ? points[i] : points[points.size() - 1 - i]; };
  double along = 0;
  std::size_t from = 0;
  std::size_t to = 1;
  for (; to + 1 < points.size() && along < 2 * width_m_; ++to) {
    along += distance(at(to - 1), at(to));
    if (along < width_m_ / 2) from = to;
  }
  const double length = std::max(distance(at(from), at(to)), 1e-9);
  return {(at(to).x_m - at(from).x_m) / length, (at(to).y_m - at(from).y_m) / length};
}

void LineGraph::drop(std::vector<std::size_t> edges) {
  std::ranges::sort(edges, std::greater{});
  for (const std::size_t e : edges) edges_.erase(edges_.begin() + static_cast<std::ptrdiff_t>(e));
}

void LineGraph::simplify() {
  do {
    join_through_nodes();
  } while (remove_spur());
  merge_close_junctions();
  join_through_nodes();
}

/// Removes only the shortest spur, because its neighbour may then become part of the line.
bool LineGraph::remove_spur() {
  const auto at = ports();
  std::optional<std::size_t> shortest;
  double shortest_m = 1.2 * width_m_;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const std::size_t first = at[edges_[e].ends[0]].size();
    const std::size_t second = at[edges_[e].ends[1]].size();
    const double length = length_of(edges_[e].points);
    if (std::min(first, second) == 1 && std::max(first, second) >= 3 && length < shortest_m) {
      shortest = e;
      shortest_m = length;
    }
  }
  if (shortest) drop({*shortest});
  return shortest.has_value();
}

void LineGraph::join_through_nodes() {
  Partners partners(edges_.size());
  for (const auto& there : ports()) {
    if (there.size() != 2) continue;
    partners[there[0].edge][there[0].end] = there[1];
    partners[there[1].edge][there[1].end] = there[0];
  }
  std::vector<Edge> joined;
  for (const Way& way : ways(partners)) {
    const Port& first = way.edges.front();
    const Port& last = way.edges.back();
    joined.push_back(
        {{edges_[first.edge].ends[first.end], edges_[last.edge].ends[1 - last.end]}, points_of(way)});
  }
  edges_ = std::move(joined);
}

std::vector<LineGraph::Way> LineGraph::ways(const Partners& partners) const {
  std::vector<Way> all;
  std::vector<bool> used(edges_.size());
  const auto walk = [&](Port port) {
    Way way;
    while (!used[port.edge]) {
      used[port.edge] = true;
      way.edges.push_back(port);
      const auto& next = partners[port.edge][1 - port.end];
      if (!next) break;
      port = *next;
    }
    way.closed = partners[way.edges.back().edge][1 - way.edges.back().end] == way.edges.front();
    all.push_back(std::move(way));
  };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
      if (!used[e] && !partners[e][end]) walk({e, end});
    }
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!used[e]) walk({e, 0});
  }
  return all;
}

std::vector<Point> LineGraph::points_of(const Way& way) const {
  std::vector<Point> points;
  for (const Port& port : way.edges) {
    std::vector<Point> next = edges_[port.edge].points;
    if (port.end == 1) std::ranges::reverse(next);
    // Edges of one node share its point; those of merged junctions do not.
    const bool shared = !points.empty() && distance(points.back(), next.front()) < 1e-9;
    points.insert(points.end(), next.begin() + (shared ? 1 : 0), next.end());
  }
  return points;
}

void LineGraph::merge_close_junctions() {
  const auto at = ports();
  std::vector<std::size_t> melted;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e].ends;
    const double length = length_of(edges_[e].points);
    const bool between_junctions =
        a != b && at[a].size() >= 3 && at[b].size() >= 3 && length < 1.5 * width_m_;
    const bool tiny_loop = a == b && length < 3 * width_m_;
    if (between_junctions || (tiny_loop && at[a].size() >= 3)) melted.push_back(e);
    if (!between_junctions) continue;
    for (Edge& edge : edges_) {
      for (std::size_t& end : edge.ends) end = end == b ? a : end;
    }
  }
  drop(std::move(melted));
}

}  // namespace tessera::sim
