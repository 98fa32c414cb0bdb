#include "cli/recordings/measured_ages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "replay/times/call_durations.hpp"
#include "tessera/printable.hpp"
#include "timing/declared.hpp"
#include "timing/words.hpp"

namespace tessera::cli {
namespace {

using nlohmann::json;

std::string in_ms(std::int64_t ns) { return fmt::format("{:.3f} ms", static_cast<double>(ns) * 1e-6); }
std::string in_ms(std::optional<std::int64_t> ns) { return ns ? in_ms(*ns) : "no bound"; }
double in_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// The bounds of each group: the largest of its chains.
void add_bounds(const spec::Model& model, std::vector<AgesOfChain>& all) {
  std::map<std::string, AgesOfChain*> of_group;
  for (AgesOfChain& one : all) of_group.emplace(one.measured.group, &one);
  const timing::Declared declared = timing::declared(model);
  const timing::Bounds bounds(declared.system);
  std::map<std::string, std::uint64_t> judged;
  for (const timing::DeclaredChain& chain : declared.chains) {
    const auto found = of_group.find(timing::without_members(chain.name));
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

/// Only the recordings say it: the specification may say more by now.
void add_timeless(std::span<const Recording> recordings, const std::vector<replay::MeasuredChain>& chains,
                  std::vector<AgesOfChain>& all) {
  std::map<std::string, std::set<std::string>> names;  // by group
  for (const Recording& recording : recordings) {
    if (recording.clock != "simulated") continue;
    replay::DurationsOfBehaviours calls;
    replay::add_durations(recording, calls);
    for (const replay::MeasuredChain& chain : chains)
      for (const std::string& subsystem : chain.subsystems)
        for (auto at = calls.lower_bound({subsystem, ""}); at != calls.end() && at->first.first == subsystem;
             ++at)
          if (at->second.count > 0 && at->second.most_ns == 0)
            names[chain.group].insert(timing::without_members(subsystem) + "." + at->first.second);
  }
  for (AgesOfChain& one : all) {
    const std::set<std::string>& found = names[one.measured.group];
    one.timeless.assign(found.begin(), found.end());
  }
}

void put_row(std::string& text, const char* name, const replay::MeasuredTimes& times,
             std::optional<std::int64_t> bound) {
  text +=
      fmt::format("  {:<9}{:>9}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}{}\n", name, times.count,
                  in_ms(times.least), in_ms(times.median), in_ms(times.p95), in_ms(times.p99),
                  in_ms(times.most), in_ms(bound), bound && times.most > *bound ? "  above the bound" : "");
}

void put_worst(std::string& text, const char* what, const AgesOfChain& one,
               const replay::MeasuredTimes& times, std::span<const std::string> names) {
  const std::string in =
      names.size() > 1 && times.worst_recording < names.size() ? " in " + names[times.worst_recording] : "";
  const std::string of = one.measured.chains > 1 ? " (" + times.worst_chain + ")" : "";
  text += fmt::format("  {}: {}, from {:.6f} s to {:.6f} s{}{}\n", what, in_ms(times.most),
                      in_seconds(times.worst_from_ns), in_seconds(times.worst_to_ns), in, of);
}

json times_json(const replay::MeasuredTimes& times, std::span<const std::string> names) {
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
std::vector<replay::MeasuredChain> named_chains(const spec::Model& model) {
  std::vector<replay::MeasuredChain> chains;
  for (const spec::TimedChain& named : *model.timing.chains) {
    replay::MeasuredChain chain{named.name, timing::without_members(named.name), {}, {{}}};
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

std::vector<replay::MeasuredChain> measured_chains(const spec::Model& model) {
  if (model.timing.chains) return named_chains(model);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::string>> channels;
  for (const spec::ChannelId id : model.channels.ids()) {
    const spec::Channel& channel = model.channels[id];
    // The firings of a model of its own do not say which one moves the value.
    if (channel.model.valid()) continue;
    channels[{channel.from.instance.value, channel.to.instance.value}].push_back(model.channel_name(channel));
  }
  std::vector<replay::MeasuredChain> chains;
  for (const spec::Agent& agent : model.agents) {
    const auto& subsystems = model.definition_of(agent).subsystems;
    for (const spec::DefinedSubsystemId from : subsystems.ids())
      for (const spec::DefinedSubsystemId to : subsystems.ids()) {
        if (subsystems[from].kind != spec::SubsystemKind::receptor ||
            subsystems[to].kind != spec::SubsystemKind::effector)
          continue;
        const std::vector<spec::InstanceId> path{agent.instance(from), agent.first_instance,
                                                 agent.instance(to)};
        replay::MeasuredChain chain;
        chain.ways = ways_along(path, channels);
        if (chain.ways.empty()) continue;
        for (const spec::InstanceId instance : path) {
          chain.subsystems.push_back(model.instance_path(instance));
          chain.name += (chain.name.empty() ? "" : " -> ") + chain.subsystems.back();
        }
        chain.group = timing::without_members(chain.name);
        chains.push_back(std::move(chain));
      }
  }
  return chains;
}

std::vector<AgesOfChain> ages_in(std::span<const Recording> recordings, const spec::Model& model) {
  const std::vector<replay::MeasuredChain> chains = measured_chains(model);
  replay::Ages ages(chains);
  for (const Recording& recording : recordings) ages.add(recording);
  std::vector<AgesOfChain> all;
  for (replay::ChainAges& one : ages.finish()) all.push_back({std::move(one), {}, {}, false, {}, {}});
  add_bounds(model, all);
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

std::string ages_text(const std::vector<AgesOfChain>& all, std::span<const std::string> names) {
  std::string text;
  for (const AgesOfChain& one : all) {
    const replay::ChainAges& measured = one.measured;
    if (!text.empty()) text += "\n";
    text += printable(measured.group);
    if (measured.chains > 1) text += fmt::format(" ({} agents)", measured.chains);
    text += "\n";
    if (measured.age.count == 0) {
      text += "  nothing is measured: " + measured.why + "\n";
      continue;
    }
    constexpr std::array columns{"min", "median", "p95", "p99", "max", "at most"};
    text += fmt::format("  {:<9}{:>9}", "", "count");
    for (const char* column : columns) text += fmt::format("{:>13}", column);
    text += "\n";
    put_row(text, "age", measured.age, one.age_ns);
    if (measured.reaction.count > 0) put_row(text, "reaction", measured.reaction, one.reaction_ns);
    put_worst(text, "oldest command", one, measured.age, names);
    if (measured.reaction.count > 0) put_worst(text, "slowest reaction", one, measured.reaction, names);
    if (measured.withheld > 0)
      text += fmt::format("  {} {} of the last subsystem gave no command: failed, or the safe command held\n",
                          measured.withheld, measured.withheld == 1 ? "call" : "calls");
    if (!one.why.empty()) text += "  no bound: " + one.why + "\n";
    if (const std::string note = timeless_note(one); !note.empty()) text += "  " + note + "\n";
  }
  if (std::ranges::any_of(all, &AgesOfChain::exceeds))
    text +=
        "\nA time above its bound: a call took longer than its `takes` (tessera replay --takes tells), a "
        "thread "
        "went on\n"
        "later than `timing: { latency }` says, or something failed.\n";
  return text;
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

}  // namespace tessera::cli
