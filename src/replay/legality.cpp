#include "replay/legality.hpp"

#include <fmt/core.h>

#include <map>
#include <utility>

#include "replay/judge.hpp"

namespace tessera::replay {

bool is_of_deployed(const Recording& recording) {
  return recording.process.has_value() || !recording.processes.empty();
}

std::optional<std::string> cannot_be_joined(std::span<const Recording> recordings,
                                            const ProcessMap& processes) {
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::size_t> seen;
  for (const Recording& recording : recordings) {
    if (!recording.process && recordings.size() > 1)
      return "one of them is of a whole system, which is judged alone; give recordings of processes only";
    if (recording.processes != processes.names)
      return "the recording is of other processes than those that the specification deploys";
    if (!recording.process) continue;
    const Recording::OneProcess& own = *recording.process;
    if (own.number >= processes.names.size() || processes.names[own.number] != own.name)
      return fmt::format("the specification deploys no process '{}' with number {}", own.name, own.number);
    if (++seen[{own.number, own.incarnation}] > 1)
      return fmt::format("two of them are of '{}' in the same start (incarnation {}); give one", own.name,
                         own.incarnation);
  }
  return std::nullopt;
}

Legality check_legal(std::span<const Recording> recordings, const net::Net& net,
                     const ProcessMap& processes) {
  if (processes.names.empty()) {
    ProcessMap one{.names = {""}, .of_agents = {}};
    for (std::size_t agent = 0; agent < net.parts().agents.size(); ++agent) one.of_agents.push_back({0});
    return check_legal(recordings, net, one);
  }
  const Recording& first = recordings.front();
  const bool is_written_in_order = !first.process && (first.clock == "simulated" || is_of_deployed(first));
  return is_written_in_order ? WrittenOrder(first, net, processes).judge()
                             : AnyOrder(recordings, net, processes).judge();
}

}  // namespace tessera::replay
