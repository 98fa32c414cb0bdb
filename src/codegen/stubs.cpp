#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/codegen.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {
namespace {

/// here: the text says request[i]; otherwise it says request, which is all of them.
void add_name(const spec::Field& field, std::string_view owner, bool here, std::string& out) {
  if (field.member) {
    const std::string name = fmt::format("{}.{}{}", owner, field.member->family, here ? "[i]" : "");
    if (here || field.member->number == 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", name);
    return;
  }
  out += fmt::format("{}{}.{}", out.empty() ? "" : ", ", owner, field.name);
}

/// used: the buffers that the behaviour sends or receives, in its order; nullopt: all.
void add_names(const Numbered<spec::BufferId, spec::Field>& fields,
               const std::optional<std::vector<spec::BufferId>>& used, std::string_view owner,
               std::string& out) {
  if (!used) {
    for (const spec::Field& field : fields) add_name(field, owner, false, out);
    return;
  }
  for (const spec::BufferId buffer : *used) {
    const std::optional<spec::Member>& member = fields[buffer].member;
    const auto of_family = std::ranges::count_if(*used, [&](spec::BufferId one) {
      return member && fields[one].member && fields[one].member->family == member->family;
    });
    add_name(fields[buffer], owner, member && of_family == 1 && member->count > 1, out);
  }
}

/// The subject of the function: its behaviour, and the buffers that this behaviour receives and sends.
std::string description(const Unit& unit, const spec::Behaviour& behaviour) {
  const spec::Subsystem& subsystem = *unit.subsystem;
  std::string reads, writes;
  if (subsystem.kind == spec::SubsystemKind::receptor)
    for (const spec::Field& field : subsystem.real) add_name(field, "in", false, reads);
  add_names(subsystem.inputs, behaviour.receive, "in", reads);
  if (subsystem.kind == spec::SubsystemKind::effector)
    for (const spec::Field& field : subsystem.real) add_name(field, "out", false, writes);
  add_names(subsystem.outputs, behaviour.send, "out", writes);
  std::string text = fmt::format(
      "/// Behaviour {} of {}.{}\n", written_name(behaviour), unit_path(unit),
      behaviour.member ? fmt::format(" One for each {}: i is context.member.", behaviour.member->fleet) : "");
  if (!reads.empty()) text += fmt::format("/// Reads {}.\n", reads);
  if (!writes.empty()) text += fmt::format("/// Writes {}.\n", writes);
  return text;
}

}  // namespace

std::vector<Stub> stubs(const spec::Model& model) {
  std::vector<Stub> all;
  const std::vector<Unit> units = units_of(model);
  for (const Unit& unit : units) {
    const std::string space = unit_namespace(model, unit);
    for (const spec::Behaviour& behaviour : unit.subsystem->behaviours) {
      if (!is_first(behaviour) || behaviour.is_group()) continue;
      Stub stub;
      stub.file = user_file(units, unit);
      stub.function = function_name(behaviour);
      stub.subsystem = unit_path(unit);
      stub.space = space;
      stub.signature = fmt::format(
          "void {}(Context& context, const Inputs& in, Memory& memory, Outputs& out)", stub.function);
      stub.preamble = fmt::format("#include \"{}\"\n\nnamespace {} {{\n", unit_header(unit), space);
      stub.body = fmt::format("{}{} {{}}\n", description(unit, behaviour), stub.signature);
      stub.closing = fmt::format("}}  // namespace {}\n", space);
      all.push_back(std::move(stub));
    }
  }
  return all;
}

}  // namespace tessera::codegen
