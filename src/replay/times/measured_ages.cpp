#include "replay/times/measured_ages.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "timing/declared.hpp"

namespace tessera::replay {
namespace {

using nlohmann::json;

/// The bounds of each group: the largest of its chains.
void add_bounds(const spec::Model& model, std::vector<AgesOfChain>& all) {
  std::map<std::string, AgesOfChain*> of_group;
  for (AgesOfChain& one : all) of_group.emplace(one.measured.group, &one);
  const timing::Declared declared = timing::declared(model);
  const timing::Bounds bounds(declared.system);
  std::map<std::string, std::uint64_t> judged;
  for (const timing::DeclaredChain& chain : declared.chains) {
    const auto found = of_group.find(fleet_name_of(chain.name));
    if (found == of_group.end()) continue;
    AgesOfChain& one = *found->second;
    const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    const bool is_first = judged[one.measured.group]++ == 0;
    one.exact = (is_first || one.exact) && verdict.exact;
    if (!verdict.why.empty()) {
      if (one.why.empty()) one.why = verdict.why;
      continue;
    }
    one.age_ns = std::max(one.age_ns.value_or(0), verdict.bound.age);
    one.reaction_ns = std::max(one.reaction_ns.value_or(0), verdict.bound.reaction);
  }
  for (AgesOfChain& one : all) {
    if (one.why.empty() && judged[one.measured.group] != one.measured.chains)
      one.why = model.timing.chains ? "`timing` does not name it"
                                    : "the behaviours of a subsystem use different channels";
    if (!one.why.empty()) one.age_ns = one.reaction_ns = std::nullopt;
  }
}

json times_json(const MeasuredTimes& times, std::span<const std::string> names) {
  json one{{"count", times.count}};
  if (times.count == 0) return one;
  one.update({{"least_ns", times.least},
              {"median_ns", times.median},
              {"p95_ns", times.p95},
              {"p99_ns", times.p99},
              {"most_ns", times.most},
              {"histogram", times.histogram}});
  one["worst"] = {
      {"chain", times.worst_chain}, {"from_ns", times.worst_from_ns}, {"to_ns", times.worst_to_ns}};
  if (times.worst_recording < names.size()) one["worst"]["recording"] = names[times.worst_recording];
  return one;
}

/// From each subsystem of the path to the next one, all ways over the channels.
std::vector<std::vector<std::string>> ways_along(
    const std::vector<spec::InstanceId>& path,
    const std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::string>>& channels) {
  std::vector<std::vector<std::string>> ways{{}};
  for (std::size_t at = 0; at + 1 < path.size(); ++at) {
    std::vector<std::vector<std::string>> longer;
    const auto found = channels.find({path[at].value, path[at + 1].value});
    if (found == channels.end()) return {};
    for (const std::string& channel : found->second)
      for (std::vector<std::string> way : ways) {
        way.push_back(channel);
        longer.push_back(std::move(way));
      }
    ways = std::move(longer);
  }
  return ways;
}

/// Those that the specification names, over the channels that it means.
std::vector<MeasuredChain> named_chains(const spec::Model& model) {
  std::vector<MeasuredChain> chains;
  for (const spec::TimedChain& named : *model.timing.chains) {
    MeasuredChain chain{named.name, fleet_name_of(named.name), {}, {{}}};
    for (const spec::InstanceId instance : named.path)
      chain.subsystems.push_back(model.instance_path(instance));
    for (const std::vector<spec::ChannelId>& hop : named.hops) {
      std::vector<std::vector<std::string>> longer;
      for (const spec::ChannelId channel : hop) {
        if (model.channels[channel].model.valid()) continue;
        for (std::vector<std::string> way : chain.ways) {
          way.push_back(model.channel_name(model.channels[channel]));
          longer.push_back(std::move(way));
        }
      }
      chain.ways = std::move(longer);
    }
    if (!chain.ways.empty()) chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace

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

std::vector<MeasuredChain> measured_chains(const spec::Model& model) {
  if (model.timing.chains) return named_chains(model);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::string>> channels;
  for (const spec::ChannelId id : model.channels.ids()) {
    const spec::Channel& channel = model.channels[id];
    // The firings of a model of its own do not say which one moves the value.
    if (channel.model.valid()) continue;
    channels[{channel.from.instance.value, channel.to.instance.value}].push_back(model.channel_name(channel));
  }
  std::vector<MeasuredChain> chains;
  for (const spec::Agent& agent : model.agents) {
    const auto& subsystems = model.definition_of(agent).subsystems;
    for (const spec::DefinedSubsystemId from : subsystems.ids())
      for (const spec::DefinedSubsystemId to : subsystems.ids()) {
        if (subsystems[from].kind != spec::SubsystemKind::receptor ||
            subsystems[to].kind != spec::SubsystemKind::effector)
          continue;
        const std::vector<spec::InstanceId> path{agent.instance(from), agent.first_instance,
                                                 agent.instance(to)};
        MeasuredChain chain;
        chain.ways = ways_along(path, channels);
        if (chain.ways.empty()) continue;
        for (const spec::InstanceId instance : path) {
          chain.subsystems.push_back(model.instance_path(instance));
          chain.name += (chain.name.empty() ? "" : " -> ") + chain.subsystems.back();
        }
        chain.group = fleet_name_of(chain.name);
        chains.push_back(std::move(chain));
      }
  }
  return chains;
}

std::vector<AgesOfChain> beside_bounds(std::vector<ChainAges> measured, const spec::Model& model) {
  std::vector<AgesOfChain> all;
  for (ChainAges& one : measured) all.push_back({std::move(one), {}, {}, false, {}});
  add_bounds(model, all);
  return all;
}

std::vector<AgesOfChain> ages_in(std::span<const Recording> recordings, const spec::Model& model) {
  Ages ages(measured_chains(model));
  for (const Recording& recording : recordings) ages.add(recording);
  return beside_bounds(ages.finish(), model);
}

json ages_json(const std::vector<AgesOfChain>& all, std::span<const std::string> names) {
  json chains = json::array();
  for (const AgesOfChain& one : all) {
    json chain{{"chain", one.measured.group},
               {"chains", one.measured.chains},
               {"age", times_json(one.measured.age, names)},
               {"reaction", times_json(one.measured.reaction, names)},
               {"withheld", one.measured.withheld},
               {"exceeds", one.exceeds()}};
    if (!one.measured.why.empty()) chain["not_measured"] = one.measured.why;
    if (one.age_ns)
      chain["bound"] = {{"age_ns", *one.age_ns}, {"reaction_ns", *one.reaction_ns}, {"exact", one.exact}};
    else
      chain["no_bound"] = one.why;
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace tessera::replay
