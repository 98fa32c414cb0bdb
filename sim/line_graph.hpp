#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "sim/bitmap.hpp"
#include "sim/track.hpp"

namespace tessera::sim {

/// A thinned line as a graph. Nodes are the points where lines end or meet; edges are the lines between them.
class LineGraph {
 public:
  struct Edge {
    std::array<std::size_t, 2> ends;  ///< nodes at points.front() and points.back()
    std::vector<Point> points;        ///< at least two
  };

  /// line_width_m: the scale of details, such as spurs and the short piece between the two junctions into
  /// which thinning splits one crossing.
  LineGraph(const Bitmap& thinned, double line_width_m);

  /// Removes dead ends about as short as the line is wide, and merges junctions that are that close.
  void simplify();
  /// Joins free ends that face each other over a gap of up to 6 cm.
  void bridge_gaps();
  /// Removes all edges that are on no loop, unless almost the whole line would vanish.
  void keep_loops();
  /// The longest way that goes straight on at crossings and uses no edge twice. A loop is preferred to an
  /// open line.
  [[nodiscard]] Skeleton longest_way() const;

 private:
  struct Port {  ///< one end of an edge
    std::size_t edge, end;
    auto operator<=>(const Port&) const = default;
  };
  /// The end at which each end of each edge continues.
  using Partners = std::vector<std::array<std::optional<Port>, 2>>;
  struct Way {
    std::vector<Port> edges;  ///< each entered at that end
    bool closed = false;
  };

  [[nodiscard]] std::vector<std::vector<Port>> ports() const;  ///< by node
  /// Unit vector into the edge, measured beyond the part that a junction distorts.
  [[nodiscard]] Point direction(const Port& port) const;
  [[nodiscard]] const Point& position_of(const Port& port) const;
  /// All edges, each in one way; open ways first.
  [[nodiscard]] std::vector<Way> ways(const Partners& partners) const;
  [[nodiscard]] std::vector<Point> points_of(const Way& way) const;
  [[nodiscard]] Partners straight_partners() const;
  [[nodiscard]] Way longest_cycle() const;
  bool remove_spur();
  void join_through_nodes();
  void merge_close_junctions();
  void drop(std::vector<std::size_t> edges);

  double width_m_;
  std::size_t nodes_ = 0;
  std::vector<Edge> edges_;
};

/// The length of a polyline.
[[nodiscard]] double length_of(const std::vector<Point>& points);

}  // namespace tessera::sim
