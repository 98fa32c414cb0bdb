#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "codegen/cpp_text.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/emit.hpp"
#include "codegen/net_tables.hpp"
#include "codegen/shared_tables.hpp"
#include "spec/model/chain_ways.hpp"
#include "timing/declared.hpp"

namespace tessera::codegen {
namespace {

constexpr std::array kinds{"control", "receptor", "effector"};
constexpr std::array verdicts{"holds", "violated", "unknown"};

/// A table of rows that may be long: columns are not aligned, the formatter keeps off.
std::string table(std::string_view type, std::string_view name, const std::string& rows) {
  if (rows.empty()) return fmt::format("constexpr std::span<const tessera::{}> {};\n", type, name);
  return fmt::format("constexpr tessera::{} {}[] = {{\n{}}};\n", type, name, rows);
}

/// ", {.overrun = ..., ...}" of what differs from the defaults; empty if nothing does.
std::string policies(const spec::Subsystem& subsystem) {
  std::vector<std::string> members;
  if (subsystem.overrun != spec::Overrun::skip)
    members.push_back(fmt::format(".overrun = tessera::Overrun::{}", name_of(subsystem.overrun)));
  if (subsystem.overtime != spec::Overtime::tell)
    members.push_back(fmt::format(".overtime = tessera::Overtime::{}", name_of(subsystem.overtime)));
  if (subsystem.watchdog) members.push_back(".watchdog = " + duration(*subsystem.watchdog));
  if (subsystem.operator_resets) members.emplace_back(".operator_resets = true");
  if (subsystem.non_finite_allowed) members.emplace_back(".non_finite_allowed = true");
  if (subsystem.realtime) {
    const spec::RealTime& real = *subsystem.realtime;
    const std::string cpu = real.cpu ? fmt::format(", .cpu = {}", *real.cpu) : "";
    members.push_back(fmt::format(".realtime = {{.policy = tessera::RealTime::Policy::{}, .priority = {}{}}}",
                                  real.policy == spec::RealTime::Policy::fifo ? "fifo" : "round_robin",
                                  real.priority, cpu));
  }
  return members.empty() ? "" : fmt::format(", {{{}}}", fmt::join(members, ", "));
}

std::string instance_row(const Project& project, const Unit& unit, spec::InstanceId instance,
                         std::uint32_t variant) {
  const spec::Subsystem& subsystem = *unit.subsystem;
  const std::string space = fmt::format("units::{}::{}", unit.definition->name, subsystem.name);
  const std::string last = policies(subsystem);
  std::string times;
  if (subsystem.period || subsystem.stale || !last.empty())
    times = ", " + duration(subsystem.period.value_or(spec::Duration{0}));
  if (subsystem.stale || !last.empty()) times += ", " + duration(subsystem.stale.value_or(spec::Duration{0}));
  times += last;
  return fmt::format("    {{\"{}\", \"{}\", tessera::Kind::{}, &{}::net{}, {}::make{}}},\n",
                     project.model.agents[project.model.instances[instance].agent].path, subsystem.name,
                     kinds[static_cast<std::size_t>(subsystem.kind)], space, variant_suffix(variant), space,
                     times);
}

/// Units go definition by definition, instances agent by agent.
std::string instance_rows(const Project& project) {
  Numbered<spec::InstanceId, std::string> rows(project.model.instances.size());
  for (std::size_t unit = 0; unit < project.units.size(); ++unit)
    for (std::size_t at = 0; at < project.units[unit].instances.size(); ++at) {
      const spec::InstanceId instance = project.units[unit].instances[at];
      rows[instance] =
          instance_row(project, project.units[unit], instance, project.nets[unit].of_instance[at]);
    }
  return fmt::to_string(fmt::join(rows, ""));
}

/// A channel that no behaviour uses has no places and no row.
std::string channel_rows(const spec::Model& model, const Numbered<spec::ChannelId, ChannelPorts>& ports,
                         const SharedTables& tables) {
  std::string rows;
  const auto end = [](spec::InstanceId instance, std::optional<std::size_t> port) {
    return port ? fmt::format("{{{}, {}}}", instance.value, *port) : fmt::format("{{{}}}", instance.value);
  };
  for (const spec::ChannelId at : model.channels.ids()) {
    const spec::Channel& channel = model.channels[at];
    if (!ports[at].from && !ports[at].to) continue;
    const SharedTables::Names& its = tables.of_channel[at];
    const std::uint32_t slots = channel.model.valid() ? model.models[channel.model].slots : 1;
    const bool all = !its.medium.empty(), until_slots = all || slots > 1;
    std::string more;
    if (channel.send_timeout || channel.receive_timeout || until_slots)
      more = ", " + duration(channel.send_timeout.value_or(spec::Duration{0}));
    if (channel.receive_timeout || until_slots)
      more += ", " + duration(channel.receive_timeout.value_or(spec::Duration{0}));
    if (until_slots) more += fmt::format(", {}", slots);
    if (all) more += ", " + its.medium;
    rows += fmt::format("    {{\"{}\", {}, {}, {}{}}},\n", model.channel_name(channel),
                        end(channel.from.instance, ports[at].from), end(channel.to.instance, ports[at].to),
                        its.places, more);
  }
  return rows;
}

std::string verdict_rows(const verify::Report& report) {
  std::string rows;
  for (const verify::PropertyResult& property : report.properties)
    rows +=
        fmt::format("    {{{}, \"{}\", {}}},\n", string_literal(property.name),
                    verdicts[static_cast<std::size_t>(property.verdict)], string_literal(property.method));
  return rows;
}

/// The tables of a deployment; empty: there is none.
std::string process_tables(const spec::Model& model) {
  if (!model.deployment) return {};
  std::string rows, numbers;
  for (const spec::Process& process : model.deployment->processes)
    rows += fmt::format("    {{{}, {}, {}}},\n", string_literal(process.name), string_literal(process.host),
                        string_literal(process.interface));
  for (const spec::Instance& instance : model.instances)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", model.agents[instance.agent].process.value);
  return table("Process", "processes", rows) +
         fmt::format("constexpr std::uint32_t process_of[] = {{{}}};\n", numbers);
}

std::string process_members(const spec::Model& model) {
  if (!model.deployment) return {};
  return fmt::format(
      ",\n    .processes = processes, .process_of = process_of, .domain = {}, .liveliness = {}",
      model.deployment->domain, duration(model.deployment->liveliness));
}

/// The resources that behaviours use; empty: there are none.
std::string resource_table(const spec::Model& model) {
  std::string rows;
  for (const spec::Resource& resource : spec::resources_of(model))
    rows += fmt::format("    {{{}, {}}},\n", string_literal(resource.name), string_literal(resource.unit));
  return rows.empty() ? rows : table("Resource", "resources", rows);
}

std::string latency_member(const spec::Model& model) {
  if (model.timing.latency == spec::Duration{0}) return {};
  return ",\n    .latency = " + duration(model.timing.latency);
}

/// A chain of which a value can be followed in the tables.
struct FollowedChain {
  std::string name, of_fleet;
  std::uint32_t member = no_member;
  timing::Time age = 0, reaction = 0;  ///< 0: there is no bound
  std::vector<std::string> ways;       ///< numbers of rows: "3, 4"

  static constexpr std::uint32_t no_member = UINT32_MAX;
  [[nodiscard]] auto bounds() const { return std::pair(age, reaction); }
};

/// 3 for "robot[3].eye -> robot[3].control", since "robot[].eye -> robot[].control" is the name of the fleet.
std::uint32_t member_in(const std::string& name, const std::string& of_fleet) {
  const std::size_t open = name.find('[');
  std::uint32_t member = FollowedChain::no_member;
  if (open == std::string::npos ||
      std::from_chars(name.data() + open + 1, name.data() + name.size(), member).ec != std::errc{})
    return FollowedChain::no_member;
  std::string expected;
  for (const char c : of_fleet) {
    expected += c;
    if (c == '[') expected += std::to_string(member);
  }
  return expected == name ? member : FollowedChain::no_member;
}

/// The proved times of chains, by name.
std::map<std::string, std::pair<timing::Time, timing::Time>> proved_times(const spec::Model& model) {
  std::map<std::string, std::pair<timing::Time, timing::Time>> all;
  const timing::Declared declared = timing::declared(model);
  const timing::Bounds bounds(declared.system);
  for (const timing::DeclaredChain& chain : declared.chains)
    if (const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
        verdict.why.empty())
      all[chain.name] = {verdict.bound.age, verdict.bound.reaction};
  return all;
}

std::vector<FollowedChain> followed_chains(const spec::Model& model,
                                           const Numbered<spec::ChannelId, ChannelPorts>& ports) {
  if (!timing::says_times(model)) return {};
  const auto proved = proved_times(model);
  Numbered<spec::ChannelId, std::optional<std::size_t>> rows(model.channels.size());
  std::size_t count = 0;
  for (const spec::ChannelId at : model.channels.ids()) {
    if (!ports[at].from && !ports[at].to) continue;
    const bool is_followed = ports[at].from && ports[at].to && !model.crosses_processes(model.channels[at]);
    rows[at] = is_followed ? std::optional(count) : std::nullopt;
    ++count;
  }
  std::vector<FollowedChain> chains;
  for (const spec::ChainWays& chain : spec::chain_ways(model)) {
    FollowedChain one;
    one.name = chain.name;
    one.of_fleet = spec::fleet_name_of(chain.name);
    one.member = member_in(one.name, one.of_fleet);
    if (const auto bounds = proved.find(chain.name); bounds != proved.end())
      std::tie(one.age, one.reaction) = bounds->second;
    for (const std::vector<spec::ChannelId>& way : chain.ways) {
      std::vector<std::size_t> numbers;
      for (const spec::ChannelId channel : way)
        if (rows[channel]) numbers.push_back(*rows[channel]);
      if (numbers.size() == way.size()) one.ways.push_back(fmt::to_string(fmt::join(numbers, ", ")));
    }
    if (!one.ways.empty()) chains.push_back(std::move(one));
  }
  return chains;
}

/// The tables of chains; empty: there is none. The chains of a fleet share a row if their bounds are equal.
std::string chain_tables(const std::vector<FollowedChain>& chains) {
  if (chains.empty()) return {};
  std::map<std::string, std::set<std::pair<timing::Time, timing::Time>>> bounds_in;
  for (const FollowedChain& chain : chains) bounds_in[chain.of_fleet].insert(chain.bounds());
  std::map<std::string, std::size_t> row_of;
  std::string rows, ways;
  for (const FollowedChain& chain : chains) {
    const bool shares = chain.member != FollowedChain::no_member && bounds_in[chain.of_fleet].size() == 1;
    const std::string& name = shares ? chain.of_fleet : chain.name;
    const auto [row, is_new] = row_of.emplace(name, row_of.size());
    const auto times = fmt::format(", {}, {}", duration(spec::Duration(chain.age)),
                                   duration(spec::Duration(chain.reaction)));
    if (is_new) rows += fmt::format("    {{{}{}}},\n", string_literal(name), chain.reaction > 0 ? times : "");
    for (const std::string& way : chain.ways)
      ways += fmt::format("    {{{}, {{{}}}{}}},\n", row->second, way,
                          shares ? fmt::format(", {}", chain.member) : "");
  }
  return table("Chain", "chains", rows) + table("ChainWay", "chain_ways", ways);
}

/// The contents of the namespace of the system.
std::set<std::string> names_in_system(const spec::Model& model) {
  std::set<std::string> names;
  for (const spec::Structure& structure : model.structures) names.insert(structure.name);
  for (const spec::Definition& definition : model.definitions) names.insert(definition.name);
  return names;
}

}  // namespace

File subsystems_header(const Project& project) {
  std::string parts;
  for (std::size_t at = 0; at < project.units.size(); ++at) {
    std::string nets;
    for (std::size_t variant = 0; variant < project.nets[at].nets.size(); ++variant)
      nets += fmt::format("extern const tessera::SubsystemNet net{};\n", variant_suffix(variant));
    const std::string space = generated_namespace(project.units[at]);
    parts += fmt::format(R"(
namespace {0} {{
{1}std::unique_ptr<tessera::Subsystem> make();
}}  // namespace {0}
)",
                         space, nets);
  }
  return {"subsystems.hpp", fmt::format(R"({}#pragma once

#include <memory>
#include <tessera/tables.hpp>

// The nets of the subsystems, and the functions that make them: {}.cpp.
{})",
                                        project.banner(), unit_path(project.units.front()), parts)};
}

File system_header(const Project& project) {
  const std::string& system = project.model.system;
  const std::string shorter =
      names_in_system(project.model).contains("system")
          ? ""
          : fmt::format("\nnamespace {0} {{\nusing tessera_generated::system;\n}}  // namespace {0}\n",
                        system);
  return {"system.hpp", fmt::format(R"({0}#pragma once

#include <tessera/tables.hpp>

namespace tessera_generated {{

/// The whole controller, for tessera::execute and tests.
[[nodiscard]] const tessera::System& system();

}}  // namespace tessera_generated
{1})",
                                    project.banner(), shorter)};
}

File system_source(const Project& project, const Numbered<spec::ChannelId, ChannelPorts>& ports,
                   const DriverTables& drivers) {
  const spec::Model& model = project.model;
  const verify::Report& report = project.net.report();
  const SharedTables shared = shared_tables(project.net.net());
  const std::string resources = resource_table(model);
  const std::string chains = chain_tables(followed_chains(model, ports));
  const std::string externs =
      declaration_of("real_drivers", drivers.real) + declaration_of("simulated_drivers", drivers.simulated);
  return {"system.cpp",
          fmt::format(R"({0}{15}#include "system.hpp"

#include <memory>
#include <span>
#include <tessera/time.hpp>

#include "subsystems.hpp"

static_assert(tessera::tables_version == {1}, "made for another version of Tessera: generate it again");

namespace tessera_generated {{

{2}namespace {{

using namespace std::chrono_literals;

// clang-format off
{4}
{3}{5}
{6}
{7}
{8}{16}constexpr tessera::System whole{{
    .tables_version = {1}, .name = "{9}",
    .net_hash = "{10}", .verification_hash = "{11}",
    .verdicts = verdicts, .instances = instances, .channels = channels,
    .system_page = &system_page, .agent_page = &agent_page,
    .real_drivers = {12}, .simulated_drivers = {13}{14}{17}}};
// clang-format on

}}  // namespace

const tessera::System& system() {{ return whole; }}

}}  // namespace tessera_generated
)",
                      project.banner(), tables_version_made, externs.empty() ? externs : externs + '\n',
                      shared.channels, table("Instance", "instances", instance_rows(project)),
                      table("Channel", "channels", channel_rows(model, ports, shared)), shared.pages,
                      table("VerifiedProperty", "verdicts", verdict_rows(report)), process_tables(model),
                      model.system, report.net_hash, report.verification_hash,
                      drivers.real.size == 0 ? "{}" : "real_drivers",
                      drivers.simulated.size == 0 ? "{}" : "simulated_drivers",
                      process_members(model) + latency_member(model) +
                          (resources.empty() ? "" : ",\n    .resources = resources"),
                      only_durations, resources + chains,
                      chains.empty() ? "" : ",\n    .chains = chains, .chain_ways = chain_ways")};
}

File main_source(const Project& project) {
  return {"main.cpp", fmt::format(R"({}#include <tessera/main.hpp>

namespace tessera_generated {{
[[nodiscard]] const tessera::System& system();
}}  // namespace tessera_generated

int main(int argc, char** argv) {{ return tessera::controller_main(tessera_generated::system(), argc, argv); }}
)",
                                  project.banner())};
}

}  // namespace tessera::codegen
