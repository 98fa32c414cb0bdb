#include "timing/worst/run_scenario.hpp"

namespace tessera::timing {

nlohmann::json scenario_json(const WorstRun& run, const RunOfChain& of,
                             const std::function<std::string(std::uint32_t)>& path) {
  nlohmann::json subsystems = nlohmann::json::array();
  for (const std::uint32_t subsystem : run.subsystems) {
    nlohmann::json calls = nlohmann::json::array();
    for (const CallOfRun& call : run.calls) {
      if (call.subsystem != subsystem) continue;
      nlohmann::json one{{"takes_ns", call.end - call.begin}};
      if (call.late > 0) one["late_ns"] = call.late;
      if (call.order != 0) one["order"] = call.order;
      calls.push_back(std::move(one));
    }
    subsystems.push_back({{"subsystem", path(subsystem)}, {"calls", std::move(calls)}});
  }
  return {{"scenario", 1},
          {"net_hash", of.net_hash},
          {"times",
           {{"chain", of.chain},
            {"of", of.is_age ? "age" : "reaction"},
            {"from_ns", run.from},
            {"to_ns", run.to},
            {"subsystems", std::move(subsystems)}}}};
}

}  // namespace tessera::timing
