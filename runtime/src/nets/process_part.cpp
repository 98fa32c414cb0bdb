#include "nets/process_part.hpp"

#include <algorithm>
#include <numeric>

#include "nets/flat_net.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::vector<std::uint32_t> up_to(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

void take_instances(ProcessPart& part, std::vector<std::uint32_t>& number_here) {
  const System& whole = *part.whole;
  for (std::uint32_t instance = 0; instance < whole.instances.size(); ++instance) {
    if (!part.has(instance)) continue;
    number_here[instance] = static_cast<std::uint32_t>(part.instances.size());
    part.instances.push_back(instance);
    part.own_instances.push_back(whole.instances[instance]);
  }
  const std::vector<AgentSpan> agents = agents_of(whole);
  for (std::uint32_t agent = 0; agent < agents.size(); ++agent)
    if (part.has(agents[agent].first)) part.agents.push_back(agent);
}

void take_channels(ProcessPart& part, const std::vector<std::uint32_t>& number_here) {
  const System& whole = *part.whole;
  for (std::uint32_t index = 0; index < whole.channels.size(); ++index) {
    Channel channel = whole.channels[index];
    if (!part.has(channel.from.instance) && !part.has(channel.to.instance)) continue;
    for (End* const end : {&channel.from, &channel.to})
      *end = part.has(end->instance) ? End{number_here[end->instance], end->port} : End{0};
    part.channels.push_back(index);
    part.own_channels.push_back(channel);
  }
}

}  // namespace

ProcessPart all_of(const System& whole) {
  ProcessPart part;
  part.whole = &whole;
  part.system = whole;
  part.instances = up_to(whole.instances.size());
  part.agents = up_to(agents_of(whole).size());
  part.channels = up_to(whole.channels.size());
  return part;
}

std::optional<ProcessPart> part_of(const System& whole, std::string_view process) {
  const auto found = std::ranges::find(whole.processes, process, &Process::name);
  if (found == whole.processes.end()) return std::nullopt;
  ProcessPart part;
  part.whole = &whole;
  part.process = static_cast<std::uint32_t>(found - whole.processes.begin());
  std::vector<std::uint32_t> number_here(whole.instances.size());
  take_instances(part, number_here);
  take_channels(part, number_here);
  part.system = whole;
  part.system.instances = part.own_instances;
  part.system.channels = part.own_channels;
  part.system.processes = {};
  part.system.process_of = {};
  return part;
}

}  // namespace tessera
