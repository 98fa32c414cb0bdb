#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// A marked graph, as a directed graph whose edges may hold tokens. Some of its edges may lose tokens
/// (docs/theory/circuits.md). Build it with node() and edge(), then close().
class EventGraph {
 public:
  struct Edge {
    std::uint32_t from = 0, to = 0;
    bool token = false;  ///< initially
    bool lossy = false;
    ChannelFlowId channel{};  ///< none: two events of one subsystem, in its order
  };

  std::uint32_t node(SubsystemFlowId subsystem);
  void edge(Edge edge) { edges_.push_back(edge); }
  /// Sorts the edges by their origin; edge numbers are valid from here on.
  void close();

  [[nodiscard]] std::size_t size() const { return subsystem_.size(); }
  [[nodiscard]] SubsystemFlowId subsystem(std::uint32_t node) const { return subsystem_[node]; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] std::span<const Edge> from(std::uint32_t node) const {
    return std::span(edges_).subspan(starts_[node], starts_[node + 1] - starts_[node]);
  }

  using Filter = std::function<bool(const Edge&)>;
  /// The strongly connected component of each node, by number, over the edges that pass the filter. Linear.
  /// Source: Tarjan, SIAM J. Comput. 1(2), 1972.
  [[nodiscard]] std::vector<std::uint32_t> components(const Filter& filter) const;
  /// The nodes that the sources reach, themselves included, over all edges.
  [[nodiscard]] std::vector<bool> reached(const std::vector<std::uint32_t>& sources) const;
  /// A shortest path over the edges that pass the filter. Empty if there is none, or from == to.
  [[nodiscard]] std::vector<Edge> path(std::uint32_t from, std::uint32_t to, const Filter& filter) const;

 private:
  std::vector<SubsystemFlowId> subsystem_;  // per node
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace tessera::verify
