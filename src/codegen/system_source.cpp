#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "codegen/cpp_text.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/emit.hpp"
#include "codegen/net_tables.hpp"
#include "codegen/shared_tables.hpp"

namespace tessera::codegen {
namespace {

constexpr std::array kinds{"control", "receptor", "effector"};
constexpr std::array verdicts{"holds", "violated", "unknown"};

/// A table of rows that may be long: columns are not aligned, the formatter keeps off.
std::string table(std::string_view type, std::string_view name, const std::string& rows) {
  if (rows.empty()) return fmt::format("constexpr std::span<const tessera::{}> {};\n", type, name);
  return fmt::format("constexpr tessera::{} {}[] = {{\n{}}};\n", type, name, rows);
}

/// "extern const tessera::CppDriver real_drivers[3];": many controllers have none.
std::string declared(std::string_view name, const DriverTables::Table& drivers) {
  if (drivers.size == 0) return {};
  return fmt::format("extern const tessera::CppDriver {}[{}];\n", name, drivers.size);
}

/// ", {.overrun = ..., ...}" of what differs from the defaults; empty if nothing does.
std::string policies(const spec::Subsystem& subsystem) {
  std::vector<std::string> members;
  if (subsystem.overrun != spec::Overrun::skip)
    members.push_back(fmt::format(".overrun = tessera::Overrun::{}", name_of(subsystem.overrun)));
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
  const std::string model_resources = resource_table(model);
  const std::string externs =
      declared("real_drivers", drivers.real) + declared("simulated_drivers", drivers.simulated);
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
{8}{17}constexpr tessera::System whole{{
    .tables_version = {1}, .name = "{9}",
    .net_hash = "{10}", .verification_hash = "{11}",
    .verdicts = verdicts, .instances = instances, .channels = channels,
    .system_page = &system_page, .agent_page = &agent_page,
    .real_drivers = {12}, .simulated_drivers = {13}{14}{16}}};
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
                      drivers.simulated.size == 0 ? "{}" : "simulated_drivers", process_members(model),
                      only_durations, model_resources.empty() ? "" : ",\n    .resources = resources",
                      model_resources)};
}

File drivers_source(const Project& project, const DriverTables& drivers) {
  const auto table_of = [](std::string_view name, const DriverTables::Table& one) {
    if (one.size == 0) return std::string();
    return fmt::format("{}const tessera::CppDriver {}[] = {{\n{}}};\n", declared(name, one), name, one.rows);
  };
  const std::string tables =
      table_of("real_drivers", drivers.real) + table_of("simulated_drivers", drivers.simulated);
  return {"system.drivers.cpp", fmt::format(R"({}#include <tessera/device.hpp>
#include <tessera/tables.hpp>

{}{}namespace tessera_generated {{

extern const char* const driver_places[];  // lines of the specification

// clang-format off
{}{}// clang-format on

}}  // namespace tessera_generated
)",
                                            project.banner(), include_block(drivers.headers), drivers.classes,
                                            drivers.options, tables)};
}

File driver_lines_source(const Project& project, const DriverTables& drivers) {
  std::string rows;
  for (const std::string& place : drivers.places) rows += fmt::format("    {},\n", string_literal(place));
  return {"system.lines.cpp", fmt::format(R"({}namespace tessera_generated {{

// The lines of the specification that messages about drivers name.
extern const char* const driver_places[];
const char* const driver_places[] = {{
{}}};

}}  // namespace tessera_generated
)",
                                          project.banner(), rows)};
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
