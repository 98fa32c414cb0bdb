#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codegen/conditions.hpp"
#include "codegen/cpp_text.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/emit.hpp"
#include "codegen/net_tables.hpp"

namespace tessera::codegen {
namespace {

using spec::SubsystemKind;

std::string bind_parameter(const spec::Parameter& parameter) {
  std::vector<std::string> accepted;
  if (parameter.minimum) accepted.push_back(fmt::format(".minimum = {}", *parameter.minimum));
  if (parameter.maximum) accepted.push_back(fmt::format(".maximum = {}", *parameter.maximum));
  if (!parameter.type.unit.empty())
    accepted.push_back(fmt::format(".unit = {}", string_literal(parameter.type.unit)));
  return fmt::format("bindings.parameter(\"{0}\", parameters.{0}{1});", parameter.name,
                     accepted.empty() ? "" : fmt::format(", {{{}}}", fmt::join(accepted, ", ")));
}

/// whole: a driver serves all real buffers at once.
std::string bind_real(const Project& project, const spec::Subsystem& subsystem, spec::RealId at, bool whole) {
  const spec::Field& field = subsystem.real[at];
  const std::string part = whole ? fmt::format(", &real.{}", field.name) : "";
  if (subsystem.kind == SubsystemKind::receptor)
    return fmt::format("bindings.real_input(\"{0}\", in.{0}{1});", field.name, part);
  // Qualified, since it stands in our namespace.
  std::set<std::string_view> hidden;
  if (field.type.kind == spec::Type::Kind::structure)
    hidden.insert(project.model.structures[field.type.structure].name);
  const std::string safe = subsystem.safe.has(at) ? subsystem.safe[at] : "";
  return fmt::format("bindings.real_output(\"{0}\", out.{0}, {1}{{{2}}}{3});", field.name,
                     type_name(project.model, field.type, hidden), safe, part);
}

/// The number that is limited stands behind the payload of the buffer, whose members are those
/// of the structure.
std::string bind_limit(const spec::Subsystem& subsystem, const spec::Limit& limit) {
  const std::string& buffer = subsystem.real[limit.real].name;
  std::vector<std::string> members;
  if (limit.minimum) members.push_back(fmt::format(".minimum = {}", *limit.minimum));
  if (limit.maximum) members.push_back(fmt::format(".maximum = {}", *limit.maximum));
  if (limit.per_second) members.push_back(fmt::format(".per_second = {}", *limit.per_second));
  if (limit.fault) members.emplace_back(".fault = true");
  const bool whole = limit.field.empty();
  return fmt::format(
      "bindings.limit(\"{}\", {}, {{{}}});", whole ? buffer : buffer + '.' + limit.field,
      whole ? fmt::format("payload(out.{})", buffer) : fmt::format("out.{}.{}", buffer, limit.field),
      fmt::join(members, ", "));
}

/// "tessera::all_finite(value.velocity) && ...": the parts of a real buffer that must be finite.
void add_finite_parts(const Project& project, const spec::Subsystem& subsystem, spec::RealId at,
                      const spec::Type& type, const std::string& field, std::vector<std::string>& parts) {
  if (subsystem.divides_non_finite(at, field)) {
    for (const spec::Field& member : project.model.structures[type.structure].fields)
      add_finite_parts(project, subsystem, at, member.type,
                       field.empty() ? member.name : field + "." + member.name, parts);
  } else if (!subsystem.may_be_non_finite(at, field)) {
    parts.push_back(fmt::format("tessera::all_finite(value{}{})", field.empty() ? "" : ".", field));
  }
}

/// nullopt: all numbers of the buffer must be finite, as those of every buffer.
std::optional<std::string> bind_non_finite(const Project& project, const spec::Subsystem& subsystem,
                                           spec::RealId at) {
  if (!subsystem.divides_non_finite(at, "") && !subsystem.may_be_non_finite(at, "")) return std::nullopt;
  std::vector<std::string> parts;
  add_finite_parts(project, subsystem, at, subsystem.real[at].type, "", parts);
  if (parts.empty())
    return fmt::format("bindings.only_finite(out.{}, [](const auto&) {{ return true; }});",
                       subsystem.real[at].name);
  return fmt::format("bindings.only_finite(out.{}, [](const auto& value) {{ return {}; }});",
                     subsystem.real[at].name, fmt::join(parts, " && "));
}

void bind_buffers(const Numbered<spec::BufferId, spec::Field>& buffers, std::string_view kind,
                  std::string_view owner, std::vector<std::string>& lines) {
  for (const spec::Field& field : buffers)
    if (is_first(field))
      lines.push_back(fmt::format("bindings.{3}{0}(\"{2}\", {1}.{2});", kind, owner, written_name(field),
                                  field.member ? "each_" : ""));
}

/// The output and the input of a goal, and the behaviours that order it, by number.
std::string bind_goal(const spec::Subsystem& subsystem, std::uint32_t cell) {
  const spec::GoalBuffers& goal = *subsystem.memory[cell].few->goal;
  std::vector<std::string> orders;
  for (const spec::BehaviourId id : subsystem.behaviours.ids())
    if (const auto& order = subsystem.behaviours[id].orders; order && order->cell == cell)
      orders.push_back(fmt::format("{{{}, {}}}", id.value, order->cancel_on_leave));
  return fmt::format("bindings.goals.push_back(tessera::bound_goal(\"{}\", out.{}, in.{}, {{{}}}));",
                     subsystem.memory[cell].name, subsystem.outputs[goal.goal].name,
                     subsystem.inputs[goal.progress].name, fmt::join(orders, ", "));
}

std::string bind(const Project& project, const Unit& unit) {
  const spec::Subsystem& subsystem = *unit.subsystem;
  std::vector<std::string> lines;
  const auto parameters = parameters_of(project.model, unit);
  const bool whole = has_whole_driver(project, unit);
  if (whole) lines.emplace_back("yours::Real& real = bindings.all_real<yours::Real>();");
  for (const spec::RealId at : subsystem.real.ids()) {
    lines.push_back(bind_real(project, subsystem, at, whole));
    if (subsystem.kind == SubsystemKind::effector)
      if (auto non_finite = bind_non_finite(project, subsystem, at)) lines.push_back(std::move(*non_finite));
    for (const spec::Limit& limit : subsystem.limits)
      if (limit.real == at) lines.push_back(bind_limit(subsystem, limit));
  }
  bind_buffers(subsystem.inputs, "input", "in", lines);
  bind_buffers(subsystem.outputs, "output", "out", lines);
  for (const spec::Field& field : subsystem.memory)
    lines.push_back(
        fmt::format("bindings.{1}(\"{0}\", memory.{0});", field.name, field.few ? "keep" : "remember"));
  for (std::uint32_t cell = 0; cell < subsystem.memory.size(); ++cell)
    if (const auto& few = subsystem.memory[cell].few; few && few->goal)
      lines.push_back(bind_goal(subsystem, cell));
  for (const spec::Parameter* parameter : parameters) lines.push_back(bind_parameter(*parameter));
  return member_function(lines.empty() ? "void bind(tessera::Bindings&) override"
                                       : "void bind(tessera::Bindings& bindings) override",
                         lines);
}

/// "behaviour" as one of the enumeration; of a family, its first, and the member in the context.
std::string kind_of_behaviour(const spec::Subsystem& subsystem) {
  std::string families;
  std::uint32_t number = 0;
  for (const spec::Behaviour& behaviour : subsystem.behaviours) {
    if (behaviour.member && behaviour.member->number == 0)
      families += fmt::format(
          "    if ({0}behaviour < {1}) return context_.member = behaviour{2}, Behaviour::{3};\n",
          number == 0 ? "" : fmt::format("behaviour >= {} && ", number), number + behaviour.member->count,
          number == 0 ? "" : fmt::format(" - {}", number), behaviour.member->family);
    ++number;
  }
  if (families.empty()) return {};
  return fmt::format(
      R"(  /// The behaviour of that number. Of one for each member of a fleet, `context.member` becomes the member.
  Behaviour behaviour_of(std::uint32_t behaviour) {{
{}    context_.member = 0;
    return static_cast<Behaviour>(behaviour);
  }}

)",
      families);
}

std::string call(const spec::Subsystem& subsystem) {
  if (subsystem.behaviours.size() == 1 && !subsystem.behaviours[0].member)
    return member_function(
        "void call(std::uint16_t) override",
        {fmt::format("yours::{}(context_, in, memory, out);", subsystem.behaviours[0].name)});
  std::string cases;
  bool groups = false;
  for (const spec::Behaviour& behaviour : subsystem.behaviours)
    if (behaviour.is_group())
      groups = true;
    else if (is_first(behaviour))
      cases +=
          fmt::format("      case Behaviour::{0}:\n        return yours::{0}(context_, in, memory, out);\n",
                      function_name(behaviour));
  if (groups) cases += "      default:  // a group is never called\n        return;\n";
  return fmt::format(R"(  void call(std::uint16_t behaviour) override {{
    switch ({}) {{
{}    }}
  }}
)",
                     Conditions::behaviour_text(subsystem), cases);
}

std::string behaviours_enumeration(const spec::Subsystem& subsystem) {
  std::vector<std::string> names;
  std::uint32_t number = 0, expected = 0;
  for (const spec::Behaviour& behaviour : subsystem.behaviours) {
    if (is_first(behaviour)) {
      const std::string name = function_name(behaviour);
      names.push_back(number == expected ? name : fmt::format("{} = {}", name, number));
      expected = number + 1;
    }
    ++number;
  }
  return enumeration("enum class Behaviour : std::uint16_t", {names.begin(), names.end()});
}

std::string subsystem_class(const Project& project, const Unit& unit, const Conditions& conditions) {
  const std::string members = conditions.members(), families = kind_of_behaviour(*unit.subsystem);
  return fmt::format(R"({}
/// The user's functions and the conditions of {}, by number.
class Subsystem final : public tessera::SubsystemOf<yours::Inputs, yours::Memory, yours::Outputs,
                                                    yours::Parameters, yours::Context> {{
 public:
{}
{}
{}
{}{}{}{}}};
)",
                     behaviours_enumeration(*unit.subsystem), unit_path(unit), bind(project, unit),
                     call(*unit.subsystem), conditions.decide(), conditions.route() + conditions.sends(),
                     members.empty() && families.empty() ? "" : "\n private:\n", families, members);
}

/// Durations stand in the table of behaviours.
bool needs_literals(const spec::Subsystem& subsystem) {
  return std::ranges::any_of(subsystem.behaviours, [](const auto& behaviour) {
    return behaviour.takes.is_declared() || !behaviour.uses.empty();
  });
}

}  // namespace

std::string source_name(const Unit& unit) { return unit_path(unit) + ".cpp"; }

File subsystem_source(const Project& project, const Unit& unit, const NetVariants& variants,
                      const Conditions& conditions) {
  std::set<std::string> headers{"<cstdint>", "<memory>", "<tessera/subsystem.hpp>", "<tessera/tables.hpp>"};
  std::set<std::string> own{string_literal("subsystems.hpp"), string_literal(unit_header(unit))};
  if (!conditions.empty()) own.insert(string_literal(conditions.header_name()));
  const std::string body = subsystem_class(project, unit, conditions);
  const bool times = needs_literals(*unit.subsystem);
  if (times) headers.insert("<tessera/time.hpp>");
  const std::string space = generated_namespace(unit);
  return {
      source_name(unit),
      fmt::format(R"({0}{9}{1}{2}namespace {3} {{
namespace {{

namespace yours = ::{4};
{5}
{6}
{7}
}}  // namespace

{8}std::unique_ptr<tessera::Subsystem> make() {{ return std::make_unique<Subsystem>(); }}

}}  // namespace {3}
)",
                  project.banner(), include_block(headers), include_block(own), space,
                  unit_namespace(project.model, unit), times ? "using namespace std::chrono_literals;\n" : "",
                  body, net_tables(project, unit, variants), net_definitions(variants), only_durations)};
}

}  // namespace tessera::codegen
