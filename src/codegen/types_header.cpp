#include <fmt/format.h>

#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"

namespace tessera::codegen {
namespace {

/// The runtime looks through the fields: for numbers that are not finite, and to record them one by one.
std::string fields_macro(const spec::Structure& structure_) {
  std::string text = "  TESSERA_FIELDS(" + structure_.name;
  for (const spec::Field& field : structure_.fields) text += ", " + field.name;
  return text + ")\n";
}

std::string definition(const Project& project, const spec::Structure& structure_) {
  std::set<std::string_view> hidden{structure_.name};
  for (const spec::Field& field : structure_.fields) hidden.insert(field.name);
  std::vector<Declaration> fields;
  for (const spec::Field& field : structure_.fields)
    fields.push_back({fmt::format("{} {}{{}};", type_name(project.model, field.type, hidden), field.name),
                      comment_text(field.type.unit)});
  std::string tail = fmt::format("\n  bool operator==(const {}&) const = default;\n", structure_.name);
  tail += fields_macro(structure_);
  return '\n' + structure(structure_.name, fields, tail);
}

}  // namespace

File types_header(const Project& project) {
  std::set<std::string> headers;
  if (!project.model.structures.empty()) headers.insert("<tessera/fields.hpp>");
  std::string structures;
  for (const spec::Structure& structure_ : project.model.structures) {
    for (const spec::Field& field : structure_.fields) add_headers(field.type, headers);
    structures += definition(project, structure_);
  }
  const std::string& system = project.model.system;
  return {"types.hpp", fmt::format(R"({}#pragma once

{}/// The types of system {}.
namespace {} {{{}}}  // namespace {}
)",
                                   project.banner(), include_block(headers), system, system,
                                   structures.empty() ? "" : '\n' + structures + '\n', system)};
}

}  // namespace tessera::codegen
