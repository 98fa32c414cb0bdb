#pragma once

#include <optional>
#include <string>
#include <vector>

#include "net/property.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// Behaviours of one subsystem, of which one is to run.
struct Running {
  net::SubsystemId subsystem;
  std::vector<std::string> behaviours;
};

/// The behaviours, if the statement says that one of several behaviours runs; nullopt: it
/// says something else.
[[nodiscard]] std::optional<Running> running(const net::HierarchicalNet& pages,
                                             const net::Statement& statement);

/// Which behaviour of a subsystem may follow which. Two more nodes stand for the end of the subsystem, and
/// for a subsystem that is stuck because no initial condition held. If the subsystem always goes on, every
/// path is a run.
class BehaviourGraph {
 public:
  explicit BehaviourGraph(const SubsystemFlow& subsystem);

  using Nodes = std::vector<bool>;
  /// The named behaviours that the subsystem can reach.
  [[nodiscard]] Nodes nodes(const std::vector<std::string>& names) const;
  [[nodiscard]] static bool any(const Nodes& nodes);
  /// The nodes from which one of `goal` can be reached, themselves included.
  [[nodiscard]] Nodes that_reach(const Nodes& goal) const;
  /// The nodes that can be reached from `start` without passing one of `around`. Nodes of `start` that are
  /// not in `around` are included.
  [[nodiscard]] Nodes reached(const Nodes& start, const Nodes& around) const;
  /// "'robot.control.stop'", "its end", ...
  [[nodiscard]] std::string name(std::size_t node) const;
  [[nodiscard]] std::size_t size() const { return next_.size(); }

 private:
  const SubsystemFlow& subsystem_;
  std::vector<std::vector<std::uint32_t>> next_;  // per node
};

}  // namespace tessera::verify
