#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/ids.hpp"

/// The times that a specification asks for (`timing:`).
namespace tessera::spec {

/// Something on the way of a chain that is not of this system: a node of ROS 2, a PLC, a person. It answers each
/// command of the effector before it, in order, and the receptor behind it reads the newest answer.
struct ForeignNode {
  std::string name;
  std::chrono::nanoseconds shortest{0}, longest{0};  ///< from a command to its answer
  std::size_t after = 0;  ///< subsystems of the path that come before it; at least 1
  diagnostics::Span span;

  bool operator==(const ForeignNode&) const = default;
};

/// A chain from a receptor over channels to an effector, and how old its commands may be.
struct TimedChain {
  std::string name;  ///< "line to wheels", in a fleet with the number of the member: "line to wheels[3]"
  /// Receptor first, effector last.
  std::vector<InstanceId> path;
  /// One fewer than the path: the channels that lead from each subsystem to the next. Empty only where a foreign node
  /// stands between them.
  std::vector<std::vector<ChannelId>> hops;
  std::optional<std::chrono::nanoseconds> age, reaction;  ///< nullopt: any
  diagnostics::Span span;                                 ///< of its name
  std::vector<ForeignNode> foreign{};

  [[nodiscard]] bool asks() const { return age || reaction; }
};

struct Timing {
  /// At most, from the moment that a thread may go on until it does.
  std::chrono::nanoseconds latency{0};
  /// At most, for a value or an acknowledgement, from one process to another. nullopt: any.
  std::optional<std::chrono::nanoseconds> network{};
  diagnostics::Span network_span{};
  /// nullopt: those from each receptor over the control subsystem to each effector of an agent.
  std::optional<std::vector<TimedChain>> chains;
};

}  // namespace tessera::spec
