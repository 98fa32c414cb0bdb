#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/ids.hpp"

/// The times that a specification asks for (`timing:`).
namespace tessera::spec {

/// A chain from a receptor over channels to an effector, and how old its commands may be.
struct TimedChain {
  std::string name;  ///< "line to wheels", in a fleet with the number of the member: "line to wheels[3]"
  /// Receptor first, effector last.
  std::vector<InstanceId> path;
  /// One fewer than the path: the channels that lead from each subsystem to the next. Never empty.
  std::vector<std::vector<ChannelId>> hops;
  std::optional<std::chrono::nanoseconds> age, reaction;  ///< nullopt: any
  diagnostics::Span span;                                 ///< of its name

  [[nodiscard]] bool asks() const { return age || reaction; }
};

struct Timing {
  /// At most, from the moment that a thread may go on until it does.
  std::chrono::nanoseconds latency{0};
  /// nullopt: those from each receptor over the control subsystem to each effector of an agent.
  std::optional<std::vector<TimedChain>> chains;
};

}  // namespace tessera::spec
