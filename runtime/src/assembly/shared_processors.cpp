#include "assembly/shared_processors.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace tessera {

void find_shared_processors(std::span<SubsystemParts> parts) {
  std::map<int, std::vector<SubsystemParts*>> on;  // by processor
  for (SubsystemParts& one : parts)
    if (one.instance->policies.realtime.cpu >= 0) on[one.instance->policies.realtime.cpu].push_back(&one);
  for (const auto& one : on) {
    const std::vector<SubsystemParts*>& sharing = one.second;
    if (sharing.size() < 2) continue;
    const auto clocks = std::make_shared<ProcessorClocks>(sharing.size());
    for (std::size_t thread = 0; thread < sharing.size(); ++thread) {
      const auto goes_before = [&](const SubsystemParts* other) {
        return other != sharing[thread] && other->instance->policies.realtime.priority >=
                                               sharing[thread]->instance->policies.realtime.priority;
      };
      sharing[thread]->processor = {clocks, thread, std::ranges::any_of(sharing, goes_before)};
    }
  }
}

}  // namespace tessera
