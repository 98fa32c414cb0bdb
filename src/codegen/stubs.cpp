#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/codegen.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {
namespace {

void add_name(const spec::Field& field, std::string_view owner, std::string& out) {
  out += fmt::format("{}{}.{}", out.empty() ? "" : ", ", owner, field.name);
}

/// used: the buffers that the behaviour sends or receives, in its order; nullopt: all.
void add_names(const Numbered<spec::BufferId, spec::Field>& fields,
               const std::optional<std::vector<spec::BufferId>>& used, std::string_view owner,
               std::string& out) {
  if (used)
    for (const spec::BufferId buffer : *used) add_name(fields[buffer], owner, out);
  else
    for (const spec::Field& field : fields) add_name(field, owner, out);
}

/// The subject of the function: its behaviour, and the buffers that this behaviour receives and sends.
std::string description(const Unit& unit, const spec::Behaviour& behaviour) {
  const spec::Subsystem& subsystem = *unit.subsystem;
  std::string reads, writes;
  if (subsystem.kind == spec::SubsystemKind::receptor)
    for (const spec::Field& field : subsystem.real) add_name(field, "in", reads);
  add_names(subsystem.inputs, behaviour.receive, "in", reads);
  if (subsystem.kind == spec::SubsystemKind::effector)
    for (const spec::Field& field : subsystem.real) add_name(field, "out", writes);
  add_names(subsystem.outputs, behaviour.send, "out", writes);
  std::string text = fmt::format("/// Behaviour {} of {}.\n", behaviour.name, unit_path(unit));
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
      Stub stub;
      stub.file = user_file(units, unit);
      stub.function = behaviour.name;
      stub.subsystem = unit_path(unit);
      stub.space = space;
      stub.signature = fmt::format(
          "void {}(Context& context, const Inputs& in, Memory& memory, Outputs& out)", behaviour.name);
      stub.preamble = fmt::format("#include \"{}\"\n\nnamespace {} {{\n", unit_header(unit), space);
      stub.body = fmt::format("{}{} {{}}\n", description(unit, behaviour), stub.signature);
      stub.closing = fmt::format("}}  // namespace {}\n", space);
      all.push_back(std::move(stub));
    }
  }
  return all;
}

}  // namespace tessera::codegen
