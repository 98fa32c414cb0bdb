#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/ids.hpp"

namespace tessera::spec {

/// One process of a deployed system.
struct Process {
  std::string name;  ///< "base"; "cart[3]" if its entry stands for one process per member of a fleet
  std::vector<AgentId> agents;  ///< ascending; never empty
  std::string host;             ///< its machine; empty: none given
  std::string interface;        ///< network interface of its machine; empty: none given
  diagnostics::Span span;       ///< of its entry
};

/// Which agents run in which process (`deploy:`). Every agent is in one process.
struct Deployment {
  std::uint32_t domain = 0;  ///< of DDS
  /// A process that was not heard of for so long is disconnected for the others. It is no part of the net.
  std::chrono::nanoseconds liveliness = std::chrono::milliseconds(900);
  Numbered<ProcessId, Process> processes;
  diagnostics::Span span;
};
/// A busy machine keeps a process from being heard for a while. The middleware forgets one after 20 s.
inline constexpr std::chrono::milliseconds shortest_liveliness{100};
inline constexpr std::chrono::seconds longest_liveliness{10};

}  // namespace tessera::spec
