#include "codegen/driver_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"

namespace tessera::codegen {
namespace {

const std::vector<spec::Driver>& simulated_drivers(const spec::Model& model) {
  static const std::vector<spec::Driver> none;
  return model.simulation ? model.simulation->drivers : none;
}

constexpr std::string_view topic_kind = "ros2";

std::string option_text(const std::string& name, const spec::DriverOption& option) {
  struct Text {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(double value) const {
      const std::string text = fmt::format("{}", value);
      return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
    }
    std::string operator()(const std::string& value) const { return string_literal(value); }
  };
  return fmt::format("{{\"{}\", {}{}}}", name, std::visit(Text{}, option.value),
                     option.unit.empty() ? "" : ", " + string_literal(option.unit));
}

/// "forward -0.5 0.5 m/s; horn", as the runtime reads it.
std::string controls_text(const spec::Panel& panel) {
  std::string text;
  for (const spec::PanelControl& one : panel.controls) {
    text += (text.empty() ? "" : "; ") + one.field;
    if (one.is_number())
      text += fmt::format(" {} {}{}{}", one.minimum, one.maximum, one.unit.empty() ? "" : " ", one.unit);
  }
  return text;
}

/// "3000000000 pause true; 5000000000 speed 0.5": nanoseconds, field and value, as the runtime reads it.
std::string script_text(const spec::Panel& panel) {
  std::string text;
  for (const spec::PanelStep& one : panel.script)
    text += fmt::format("{}{} {} {}", text.empty() ? "" : "; ", one.at.count(), one.field,
                        std::visit([](auto value) { return fmt::format("{}", value); }, one.value));
  return text;
}

/// Writes the rows; drivers with the same options share a table of them.
class Writer {
 public:
  explicit Writer(const Project& project) : project_(project), model_(project.model) {}

  DriverTables::Table rows(const std::vector<spec::Driver>& drivers) {
    std::vector<std::pair<std::string, const spec::Driver*>> sorted;
    for (const spec::Driver& driver : drivers)
      if (!driver.is_of_world()) sorted.emplace_back(model_.driver_path(driver), &driver);
    std::ranges::stable_sort(sorted, {}, [](const auto& one) { return one.first; });
    DriverTables::Table table{"", sorted.size()};
    for (const auto& [path, driver] : sorted) table.rows += row(path, *driver);
    return table;
  }

  DriverTables finish(DriverTables::Table real, DriverTables::Table simulated) {
    return {definitions_.empty() ? "" : definitions_ + '\n',
            std::move(real),
            std::move(simulated),
            classes(),
            std::move(headers_),
            std::move(places_)};
  }

 private:
  std::string row(const std::string& path, const spec::Driver& driver) {
    const bool reads = model_.subsystem(driver.instance).kind == spec::SubsystemKind::receptor;
    if (driver.kind == topic_kind) return topic_row(path, driver, reads);
    if (driver.panel) return panel_row(path, driver);
    headers_.insert(string_literal("drivers.hpp"));
    const std::string device = alias(driver.target());
    const std::string make = fmt::format("tessera::make_driver<tessera::{}, {}, {}>",
                                         reads ? "RealReceptor" : "RealEffector", value(driver), device);
    return fmt::format(
        "    {{\"{}\", \"{}\", {}, {}, {}}},\n", path, driver.target(), place(driver), options(driver),
        reads ? make + ", nullptr" : fmt::format("nullptr, {}, tessera::is_guarded<{}>", make, device));
  }

  /// Those that write can be given to the guardian process, except for replies: their clients asked a process
  /// that has died.
  std::string topic_row(const std::string& path, const spec::Driver& driver, bool reads) {
    headers_.insert(string_literal("tessera/ros2.hpp"));
    spec::Driver with_topic = driver;
    with_topic.options["topic"] = spec::DriverOption{driver.target(), ""};
    const std::string make =
        fmt::format("tessera::ros2_{}<{}>", reads ? "receptor" : "effector", value(driver));
    const auto role = driver.options.find("role");
    const bool is_server = role != driver.options.end() &&
                           role->second.value == decltype(role->second.value)(std::string("server"));
    return fmt::format("    {{\"{}\", \"{}\", {}, {}, {}}},\n", path, "ros2", place(driver),
                       options(with_topic),
                       reads ? make + ", nullptr" : "nullptr, " + make + (is_server ? "" : ", true"));
  }

  std::string panel_row(const std::string& path, const spec::Driver& driver) {
    headers_.insert(string_literal("tessera/panel.hpp"));
    spec::Driver with_controls = driver;
    with_controls.options["controls"] = spec::DriverOption{controls_text(*driver.panel), ""};
    with_controls.options["stale"] =
        spec::DriverOption{std::chrono::duration<double>(driver.panel->stale).count(), "s"};
    if (!driver.panel->script.empty())
      with_controls.options["script"] = spec::DriverOption{script_text(*driver.panel), ""};
    return fmt::format("    {{\"{}\", \"{}\", {}, {}, tessera::panel_receptor<{}>, nullptr}},\n", path,
                       "panel", place(driver), options(with_controls), value(driver));
  }

  /// Its place in the specification stands in a table of its own, so that a moved line changes no row.
  std::string place(const spec::Driver& driver) {
    places_.push_back(project_.at(driver.span));
    return fmt::format("&driver_places[{}]", places_.size() - 1);
  }

  /// The type that the driver reads or writes.
  std::string value(const spec::Driver& driver) {
    const Unit& unit = unit_of(driver.instance);
    headers_.insert(string_literal(unit_header(unit)));
    if (!driver.real.valid()) return fmt::format("::{}::Real", unit_namespace(model_, unit));
    const spec::Type& type = unit.subsystem->real[driver.real].type;
    std::set<std::string_view> hidden;  // qualified, since it stands in our namespace
    if (type.kind == spec::Type::Kind::structure) hidden.insert(model_.structures[type.structure].name);
    return type_name(model_, type, hidden);
  }

  const Unit& unit_of(spec::InstanceId instance) const {
    const spec::Subsystem* const subsystem = &model_.subsystem(instance);
    return *std::ranges::find(project_.units, subsystem, &Unit::subsystem);
  }

  /// The specification names classes as they are seen from the namespace of the system.
  std::string alias(const std::string& target) {
    const auto [known, added] =
        aliases_.emplace(target, fmt::format("tessera_driver_{}", aliases_.size() + 1));
    if (added) using_ += fmt::format("using {} = {};\n", known->second, target);
    return fmt::format("::{}::{}", model_.system, known->second);
  }

  [[nodiscard]] std::string classes() const {
    if (using_.empty()) return using_;
    return fmt::format(R"(// The classes of the drivers, by the names that the specification gives them.
namespace {0} {{
namespace {{
{1}}}  // namespace
}}  // namespace {0}

)",
                       model_.system, using_);
  }

  std::string options(const spec::Driver& driver) {
    if (driver.options.empty()) return "{}";
    std::vector<std::string> texts;
    for (const auto& [name, option] : driver.options) texts.push_back(option_text(name, option));
    const std::string all = fmt::to_string(fmt::join(texts, ", "));
    const auto [known, added] = tables_.emplace(all, fmt::format("driver_options_{}", tables_.size()));
    if (added)
      definitions_ += fmt::format("constexpr tessera::DriverOption {}[] = {{{}}};\n", known->second, all);
    return known->second;
  }

  const Project& project_;
  const spec::Model& model_;
  std::map<std::string, std::string> tables_;  ///< options as text -> name of their table
  std::string definitions_;
  std::map<std::string, std::string> aliases_;  ///< class -> what the rows call it
  std::string using_;
  std::set<std::string> headers_;
  std::vector<std::string> places_;
};

}  // namespace

DriverTables driver_tables(const Project& project) {
  Writer writer(project);
  DriverTables::Table real = writer.rows(project.model.drivers);
  return writer.finish(std::move(real), writer.rows(simulated_drivers(project.model)));
}

bool has_whole_driver(const Project& project, const Unit& unit) {
  const auto serves_unit = [&](const spec::Driver& driver) {
    return !driver.real.valid() && &project.model.subsystem(driver.instance) == unit.subsystem;
  };
  return std::ranges::any_of(project.model.drivers, serves_unit) ||
         std::ranges::any_of(simulated_drivers(project.model), serves_unit);
}

std::string declaration_of(std::string_view name, const DriverTables::Table& drivers) {
  if (drivers.size == 0) return {};
  return fmt::format("extern const tessera::CppDriver {}[{}];\n", name, drivers.size);
}

File drivers_source(const Project& project, const DriverTables& drivers) {
  const auto table_of = [](std::string_view name, const DriverTables::Table& one) {
    if (one.size == 0) return std::string();
    return fmt::format("{}const tessera::CppDriver {}[] = {{\n{}}};\n", declaration_of(name, one), name,
                       one.rows);
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

}  // namespace tessera::codegen
