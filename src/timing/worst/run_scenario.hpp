// A worst run as a file, from which the generated controller makes it again.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "timing/worst/worst_run.hpp"

namespace tessera::timing {

/// A run, and the question that it answers.
struct RunOfChain {
  std::string chain;       ///< its name
  bool is_age = false;     ///< else its reaction
  std::string net_hash{};  ///< of the controller
};

/// The scenario for `tessera simulate --scenario`: {scenario, net_hash, times: {chain, of, from_ns, to_ns, subsystems:
/// [{subsystem, calls: [{takes_ns, late_ns?, order?}]}]}}.
/// path: of a subsystem. Precondition: the run is one of the simulated clock.
[[nodiscard]] nlohmann::json scenario_json(const WorstRun& run, const RunOfChain& of,
                                           const std::function<std::string(std::uint32_t)>& path);

}  // namespace tessera::timing
