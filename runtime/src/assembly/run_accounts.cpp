#include "assembly/run_accounts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tessera {
namespace {

void add_used(const SubsystemExecutor& executor, const std::string& agent, Time now,
              std::vector<RunSummary::Used>& all) {
  const Operations& operations = executor.operations();
  const std::vector<Duration> times = operations.present().until(now);
  for (std::size_t behaviour = 0; behaviour < times.size(); ++behaviour)
    for (const Use& use : operations.parts().instance->net->behaviours[behaviour].uses) {
      RunSummary::Used& sum = all[use.resource];
      const double amount = use.per_second * seconds(times[behaviour]);
      sum.amount += amount;
      const auto of = std::ranges::find(sum.agents, agent, &std::pair<std::string, double>::first);
      if (of == sum.agents.end())
        sum.agents.emplace_back(agent, amount);
      else
        of->second += amount;
    }
}

}  // namespace

std::vector<RunSummary::Used> used_resources(const Assembly& assembly, Time now) {
  std::vector<RunSummary::Used> all;
  for (const Resource& resource : assembly.system.resources)
    all.push_back({std::string(resource.name), std::string(resource.unit), 0, {}});
  if (all.empty()) return all;
  for (const auto* executors : {&assembly.dead, &assembly.executors})
    for (const auto& executor : *executors)
      add_used(*executor, std::string(executor->operations().parts().instance->agent), now, all);
  return all;
}

std::vector<RunSummary::SlowCalls> slow_calls(const Assembly& assembly) {
  std::vector<RunSummary::SlowCalls> all;
  for (const auto& executor : assembly.executors) {
    const Operations& operations = executor->operations();
    const std::span<const Behaviour> behaviours = operations.parts().instance->net->behaviours;
    for (std::size_t at = 0; at < behaviours.size(); ++at)
      if (const Overtimes::OfBehaviour& one = operations.overtimes().behaviours()[at]; one.slow > 0)
        all.push_back({fmt::format("{}.{}", executor->path(), behaviours[at].name), one.calls, one.slow,
                       one.declared, one.longest, one.longest_at});
  }
  return all;
}

}  // namespace tessera
