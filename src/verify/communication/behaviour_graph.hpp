#pragma once

#include <optional>
#include <string>
#include <vector>

#include "net/property.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// Behaviours of one subsystem; one of them is to run.
struct Running {
  std::uint32_t subsystem = 0;  ///< Page::subsystem
  std::vector<std::string> behaviours;
};

/// The behaviours of which the statement says that one of them runs; nullopt: it says something else.
[[nodiscard]] std::optional<Running> running(const net::HierarchicalNet& pages,
                                             const net::Statement& statement);

/// Which behaviour of a subsystem may follow which, with two more nodes: it has ended, and it is lost because
/// no initial condition held. Every path is a run, if the subsystem always goes on.
class BehaviourGraph {
 public:
  explicit BehaviourGraph(const SubsystemFlow& subsystem);

  using Nodes = std::vector<bool>;
  /// Those of the names that the subsystem can reach.
  [[nodiscard]] Nodes nodes(const std::vector<std::string>& names) const;
  [[nodiscard]] static bool any(const Nodes& nodes);
  /// The nodes from which one of `goal` can be reached, themselves included.
  [[nodiscard]] Nodes that_reach(const Nodes& goal) const;
  /// The nodes that can be reached from `start` without passing one of `around`; those of `start` that are
  /// not in `around` included.
  [[nodiscard]] Nodes reached(const Nodes& start, const Nodes& around) const;
  /// "'robot.control.stop'", "its end", ...
  [[nodiscard]] std::string name(std::size_t node) const;
  [[nodiscard]] std::size_t size() const { return next_.size(); }

 private:
  const SubsystemFlow& subsystem_;
  std::vector<std::vector<std::uint32_t>> next_;  // per node
};

}  // namespace tessera::verify
