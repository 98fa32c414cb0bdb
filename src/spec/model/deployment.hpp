#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace tessera::spec {

/// One process of a deployed system.
struct Process {
  std::string name;  ///< "base"; "cart[3]" if its entry stands for one process per member of a fleet
  std::vector<std::uint32_t> agents;  ///< into Model::agents, ascending; never empty
  std::string host;                   ///< its machine; empty: none given
  std::string interface;              ///< network interface of its machine; empty: none given
  diagnostics::Span span;             ///< of its entry
};

/// Which agents run in which process (`deploy:`). Every agent is in one process.
struct Deployment {
  std::uint32_t domain = 0;  ///< of DDS
  std::vector<Process> processes;
  diagnostics::Span span;
};

}  // namespace tessera::spec
