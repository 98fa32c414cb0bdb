#include <fmt/format.h>

#include "codegen/codegen.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {
namespace {

void add_names(const std::vector<spec::Field>& fields, std::string_view owner, std::string& out) {
  for (const spec::Field& field : fields)
    out += fmt::format("{}{}.{}", out.empty() ? "" : ", ", owner, field.name);
}

/// The subject of the function: its behaviour, and the buffers that it reads and writes.
std::string description(const Unit& unit, const spec::Behaviour& behaviour) {
  const spec::Subsystem& subsystem = *unit.subsystem;
  std::string reads, writes;
  if (subsystem.kind == spec::SubsystemKind::receptor) add_names(subsystem.real, "in", reads);
  add_names(subsystem.inputs, "in", reads);
  if (subsystem.kind == spec::SubsystemKind::effector) add_names(subsystem.real, "out", writes);
  add_names(subsystem.outputs, "out", writes);
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
