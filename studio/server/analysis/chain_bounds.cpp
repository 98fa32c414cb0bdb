#include "server/analysis/chain_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "timing/changes.hpp"
#include "timing/declared.hpp"
#include "timing/steps.hpp"
#include "timing/words.hpp"
#include "timing/worst/worst_run.hpp"

namespace tessera::server {
namespace {

using nlohmann::json;
using spec::InstanceId;
using timing::Time;

/// "robot.control" for "robot[3].control"
std::string without_member(const std::string& path) {
  const std::size_t from = path.find('['), to = path.find(']');
  return from == std::string::npos || to < from ? path : path.substr(0, from) + path.substr(to + 1);
}

std::vector<InstanceId> instances_at(const spec::Model& model, const std::string& path) {
  std::optional<spec::Instance> found;
  for (const InstanceId id : model.instances.ids()) {
    const std::string name = model.instance_path(id);
    if (name != path && without_member(name) != path) continue;
    found = model.instances[id];
    break;
  }
  std::vector<InstanceId> all;
  if (!found) return all;
  const spec::DefinitionId definition = model.agents[found->agent].definition;
  for (const InstanceId id : model.instances.ids())
    if (const spec::Instance& one = model.instances[id];
        one.subsystem == found->subsystem && model.agents[one.agent].definition == definition)
      all.push_back(id);
  return all;
}

/// Returns why they cannot be changed; empty: they are.
std::string change(timing::Declared& declared, const spec::Model& model, const OtherTimes& other) {
  const std::vector<InstanceId> instances = instances_at(model, other.path);
  if (instances.empty()) return fmt::format("there is no subsystem {}", other.path);
  for (const InstanceId instance : instances) {
    timing::Subsystem& mine = declared.system.subsystems[instance.value];
    if (other.period >= 0) mine.period = other.period;
    if (other.shortest < 0 && other.longest < 0) continue;
    if (const std::string& why = declared.missing[instance.value]; !why.empty()) return why;
    if (other.shortest >= 0) mine.shortest = other.shortest;
    if (other.longest >= 0) mine.longest = other.longest;
    if (mine.shortest < 1 || mine.shortest > mine.longest)
      return fmt::format("{} cannot take from {} to {} ns", other.path, mine.shortest, mine.longest);
  }
  return {};
}

json time_of(Time time) { return time >= timing::unbounded ? json(nullptr) : json(time); }

json bound_of(const timing::ChainVerdict& verdict, Time time, const std::optional<Time>& asked,
              timing::Answer answer) {
  return {{"at_most_ns", verdict.why.empty() ? time_of(time) : json(nullptr)},
          {"asked_ns", asked ? json(*asked) : json(nullptr)},
          {"answer", word_of(answer)}};
}

std::string channel_name(const spec::Model& model, std::uint32_t channel) {
  return model.channel_name(model.channels[spec::ChannelId{channel}]);
}

json steps_json(const std::vector<timing::Step>& steps, const spec::Model& model) {
  json all = json::array();
  for (const timing::Step& step : steps)
    all.push_back(
        {{"kind", word_of(step.kind)},
         {"subsystem", model.instance_path(InstanceId{step.subsystem})},
         {"channel", step.kind == timing::Step::Kind::until_read ? json(channel_name(model, step.channel))
                                                                 : json(nullptr)},
         {"ns", step.time}});
  return all;
}

json steps_of(const timing::DeclaredChain& chain, const timing::Bounds& bounds, const spec::Model& model) {
  const timing::ChainSteps steps = timing::steps_of(bounds, chain.ways);
  return {{"age", steps_json(steps.age, model)}, {"reaction", steps_json(steps.reaction, model)}};
}

/// Empty: it has several, and the run does not say which.
std::string behaviour_of(const spec::Model& model, std::uint32_t subsystem) {
  std::string name;
  for (const spec::Behaviour& behaviour : model.subsystem(InstanceId{subsystem}).behaviours) {
    if (behaviour.is_group()) continue;
    if (!name.empty()) return {};
    name = behaviour.name;
  }
  return name;
}

json run_json(const timing::WorstRun& run, Time bound, const timing::Declared& declared,
              const spec::Model& model) {
  json calls = json::array(), hops = json::array();
  for (const timing::CallOfRun& call : run.calls)
    if (call.end >= run.from)
      calls.push_back({{"subsystem", model.instance_path(InstanceId{call.subsystem})},
                       {"behaviour", behaviour_of(model, call.subsystem)},
                       {"begin_ns", call.begin},
                       {"end_ns", call.end}});
  for (const timing::HopOfRun& hop : run.hops)
    hops.push_back({{"channel", channel_name(model, hop.channel)},
                    {"from", model.instance_path(InstanceId{declared.system.channels[hop.channel].from})},
                    {"to", model.instance_path(InstanceId{declared.system.channels[hop.channel].to})},
                    {"written_ns", hop.written},
                    {"read_ns", hop.read}});
  return {{"from_ns", run.from},    {"to_ns", run.to},           {"at_most_ns", bound},
          {"reaches", run.reaches}, {"calls", std::move(calls)}, {"hops", std::move(hops)}};
}

}  // namespace

std::variant<json, std::string> chain_worst_run(const spec::Model& model,
                                                const std::vector<OtherTimes>& others,
                                                const std::string& name, bool age) {
  timing::Declared declared = timing::declared(model);
  for (const OtherTimes& other : others)
    if (std::string why = change(declared, model, other); !why.empty()) return why;
  const auto chain = std::ranges::find(declared.chains, name, &timing::DeclaredChain::name);
  if (chain == declared.chains.end()) return fmt::format("there is no chain {}", name);
  const timing::Bounds bounds(declared.system);
  const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, *chain);
  if (!verdict.why.empty()) return json{{"run", nullptr}, {"why", verdict.why}};
  timing::WorstRunSearch search(declared, bounds);
  for (const timing::Chain& way : chain->ways)
    if (std::string why = search.obstacle(way, model); !why.empty())
      return json{{"run", nullptr}, {"why", why}};
  const timing::WorstRuns runs = search.find(*chain);
  const std::optional<timing::WorstRun>& run = age ? runs.age : runs.reaction;
  if (!run) return json{{"run", nullptr}, {"why", "no run was found in which a command is given"}};
  return json{{"run", run_json(*run, age ? verdict.bound.age : verdict.bound.reaction, declared, model)},
              {"why", ""}};
}

std::variant<json, std::string> chain_bounds(const spec::Model& model, const std::vector<OtherTimes>& others,
                                             const std::string& explained) {
  timing::Declared declared = timing::declared(model);
  for (const OtherTimes& other : others)
    if (std::string why = change(declared, model, other); !why.empty()) return why;
  const timing::Bounds bounds(declared.system);
  json chains = json::array(), subsystems = json::array();
  std::set<std::uint32_t> told;
  const auto receive_blocks = [&](std::uint32_t channel) {
    return declared.system.channels[channel].receive_blocks;
  };
  json steps = nullptr;
  // Members of a fleet whose chains have equal verdicts are one entry.
  std::map<std::tuple<std::string, Time, Time, bool, std::string>, std::size_t> entries;
  for (const timing::DeclaredChain& chain : declared.chains) {
    const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    if (chain.name == explained && verdict.why.empty()) steps = steps_of(chain, bounds, model);
    std::string name = chain.is_named ? without_member(chain.name) + ":" : "";
    json path = json::array();
    for (const InstanceId instance : chain.path) {
      path.push_back(model.instance_path(instance));
      name += " " + without_member(path.back());
    }
    const auto [at, is_new] = entries.try_emplace(
        {name, verdict.bound.age, verdict.bound.reaction, verdict.exact, without_member(verdict.why)},
        chains.size());
    if (!is_new) {
      json& agents = chains[at->second]["agents"];
      agents = agents.get<int>() + 1;
      continue;
    }
    std::set<std::uint32_t> channels;
    for (const timing::Chain& way : chain.ways) channels.insert(way.begin(), way.end());
    json ends = json::array();
    for (const std::uint32_t channel : channels) ends.push_back(channel_name(model, channel));
    chains.push_back(
        {{"name", chain.name},
         {"named", chain.is_named},
         {"path", std::move(path)},
         {"channels", std::move(ends)},
         {"agents", 1},
         {"age", bound_of(verdict, verdict.bound.age, chain.age, verdict.age)},
         {"reaction", bound_of(verdict, verdict.bound.reaction, chain.reaction, verdict.reaction)},
         {"exact", verdict.exact},
         {"why", verdict.why}});
    for (const InstanceId instance : chain.path) {
      if (!told.insert(instance.value).second) continue;
      const timing::Subsystem& mine = declared.system.subsystems[instance.value];
      subsystems.push_back({{"path", model.instance_path(instance)},
                            {"period_ns", mine.period},
                            {"shortest_ns", time_of(mine.shortest)},
                            {"longest_ns", time_of(mine.longest)},
                            {"waits", std::ranges::any_of(mine.receives, receive_blocks)},
                            {"missing", declared.missing[instance.value]}});
    }
  }
  return json{
      {"chains", std::move(chains)}, {"subsystems", std::move(subsystems)}, {"steps", std::move(steps)}};
}

std::variant<json, std::string> chain_changes(const spec::Model& model, const std::string& name) {
  const timing::Declared declared = timing::declared(model);
  const auto chain = std::ranges::find(declared.chains, name, &timing::DeclaredChain::name);
  if (chain == declared.chains.end()) return fmt::format("there is no chain {}", name);
  json changes = json::array();
  for (const timing::Change& change : timing::changes_for(declared, *chain)) {
    const bool of_channel = change.kind != timing::Change::Kind::twice_the_rate &&
                            change.kind != timing::Change::Kind::own_processor;
    changes.push_back({{"kind", word_of(change.kind)},
                       {"subsystem", model.instance_path(InstanceId{change.subsystem})},
                       {"channel", of_channel ? json(channel_name(model, change.channel)) : json(nullptr)},
                       {"age_ns", time_of(change.age)},
                       {"reaction_ns", time_of(change.reaction)}});
  }
  return json{{"changes", std::move(changes)}};
}

}  // namespace tessera::server
