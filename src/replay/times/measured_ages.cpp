#include "replay/times/measured_ages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "replay/times/call_durations.hpp"
#include "spec/model/chain_ways.hpp"
#include "tessera/printable.hpp"
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
    const auto found = of_group.find(spec::fleet_name_of(chain.name));
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

/// A recording does not show what a foreign node does between two devices.
void add_unmeasured(const spec::Model& model, std::vector<AgesOfChain>& all) {
  if (!model.timing.chains) return;
  for (const spec::TimedChain& chain : *model.timing.chains) {
    if (chain.foreign.empty()) continue;
    const std::string group = spec::fleet_name_of(chain.name);
    auto found = std::ranges::find(all, group, [](const AgesOfChain& one) { return one.measured.group; });
    if (found == all.end()) {
      found = all.insert(all.end(), AgesOfChain{});
      found->measured.group = group;
      found->measured.why = chain.foreign.front().name + " is not of this system: nothing is recorded of it";
    }
    ++found->measured.chains;
  }
}

/// Only the recordings say it: the specification may say more by now.
void add_timeless(std::span<const Recording> recordings, const std::vector<MeasuredChain>& chains,
                  std::vector<AgesOfChain>& all) {
  std::map<std::string, std::set<std::string>> names;  // by group
  for (const Recording& recording : recordings) {
    if (recording.clock != "simulated") continue;
    DurationsOfBehaviours calls;
    add_durations(recording, calls);
    for (const MeasuredChain& chain : chains)
      for (const std::string& subsystem : chain.subsystems)
        for (auto at = calls.lower_bound({subsystem, ""}); at != calls.end() && at->first.first == subsystem;
             ++at)
          if (at->second.count > 0 && at->second.most_ns == 0)
            names[chain.group].insert(spec::fleet_name_of(subsystem) + "." + at->first.second);
  }
  for (AgesOfChain& one : all) {
    const std::set<std::string>& found = names[one.measured.group];
    one.timeless.assign(found.begin(), found.end());
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

}  // namespace

std::vector<MeasuredChain> measured_chains(const spec::Model& model) {
  std::vector<MeasuredChain> chains;
  for (const spec::ChainWays& one : spec::chain_ways(model)) {
    MeasuredChain& chain =
        chains.emplace_back(MeasuredChain{one.name, spec::fleet_name_of(one.name), {}, {}});
    for (const spec::InstanceId instance : one.path)
      chain.subsystems.push_back(model.instance_path(instance));
    for (const std::vector<spec::ChannelId>& way : one.ways) {
      std::vector<std::string>& names = chain.ways.emplace_back();
      for (const spec::ChannelId channel : way) names.push_back(model.channel_name(model.channels[channel]));
    }
  }
  return chains;
}

std::vector<AgesOfChain> beside_bounds(std::vector<ChainAges> measured, const spec::Model& model) {
  std::vector<AgesOfChain> all;
  for (ChainAges& one : measured) all.push_back({std::move(one), {}, {}, false, {}, {}});
  add_unmeasured(model, all);
  add_bounds(model, all);
  return all;
}

std::vector<AgesOfChain> ages_in(std::span<const Recording> recordings, const spec::Model& model) {
  const std::vector<MeasuredChain> chains = measured_chains(model);
  Ages ages(chains);
  for (const Recording& recording : recordings) ages.add(recording);
  std::vector<AgesOfChain> all = beside_bounds(ages.finish(), model);
  add_timeless(recordings, chains, all);
  return all;
}

std::string timeless_note(const AgesOfChain& one) {
  if (one.timeless.empty()) return {};
  constexpr std::size_t shown = 3;
  std::string names;
  for (std::size_t index = 0; index < std::min(one.timeless.size(), shown); ++index)
    names += (index == 0 ? "" : ", ") + one.timeless[index];
  if (one.timeless.size() > shown) names += fmt::format(" and {} more", one.timeless.size() - shown);
  return printable(
      fmt::format("a simulation in which the calls of {} take no time, because they have no `takes`: a real "
                  "robot is slower",
                  names));
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
    if (!one.timeless.empty()) chain["takes_no_time"] = one.timeless;
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace tessera::replay
