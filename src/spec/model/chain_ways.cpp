#include "spec/model/chain_ways.hpp"

#include <map>
#include <utility>

namespace tessera::spec {
namespace {

using Hop = std::vector<ChannelId>;

std::vector<std::vector<ChannelId>> ways_over(const Model& model, const std::vector<Hop>& hops) {
  std::vector<std::vector<ChannelId>> ways{{}};
  for (const Hop& hop : hops) {
    std::vector<std::vector<ChannelId>> longer;
    for (const ChannelId channel : hop) {
      if (model.channels[channel].model.valid()) continue;
      for (std::vector<ChannelId> way : ways) {
        way.push_back(channel);
        longer.push_back(std::move(way));
      }
    }
    ways = std::move(longer);
  }
  return ways;
}

std::vector<ChainWays> named_chains(const Model& model) {
  std::vector<ChainWays> chains;
  for (const TimedChain& named : *model.timing.chains) {
    ChainWays chain{named.name, named.path, ways_over(model, named.hops)};
    if (!chain.ways.empty()) chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace

std::vector<ChainWays> chain_ways(const Model& model) {
  if (model.timing.chains) return named_chains(model);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Hop> channels;
  for (const ChannelId id : model.channels.ids())
    channels[{model.channels[id].from.instance.value, model.channels[id].to.instance.value}].push_back(id);
  const auto hop_of = [&](InstanceId from, InstanceId to) {
    const auto found = channels.find({from.value, to.value});
    return found == channels.end() ? Hop{} : found->second;
  };
  std::vector<ChainWays> chains;
  for (const Agent& agent : model.agents) {
    const auto& subsystems = model.definition_of(agent).subsystems;
    for (const DefinedSubsystemId from : subsystems.ids())
      for (const DefinedSubsystemId to : subsystems.ids()) {
        if (subsystems[from].kind != SubsystemKind::receptor ||
            subsystems[to].kind != SubsystemKind::effector)
          continue;
        ChainWays chain;
        chain.path = {agent.instance(from), agent.first_instance, agent.instance(to)};
        chain.ways =
            ways_over(model, {hop_of(chain.path[0], chain.path[1]), hop_of(chain.path[1], chain.path[2])});
        if (chain.ways.empty()) continue;
        for (const InstanceId instance : chain.path)
          chain.name += (chain.name.empty() ? "" : " -> ") + model.instance_path(instance);
        chains.push_back(std::move(chain));
      }
  }
  return chains;
}

std::string fleet_name_of(const std::string& name) {
  std::string result;
  bool inside = false;
  for (const char c : name) {
    if (c == ']') inside = false;
    if (!inside) result += c;
    if (c == '[') inside = true;
  }
  return result;
}

}  // namespace tessera::spec
