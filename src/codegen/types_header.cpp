#include <fmt/format.h>

#include <algorithm>

#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"

namespace tessera::codegen {
namespace {

bool has_floats(const spec::Model& model, const spec::Structure& structure_) {
  return std::ranges::any_of(structure_.fields, [&](const spec::Field& field) {
    const spec::Type& type = field.type;
    if (type.kind == spec::Type::Kind::structure) return has_floats(model, model.structures[type.structure]);
    return type.kind == spec::Type::Kind::scalar &&
           (type.scalar == spec::Scalar::float32 || type.scalar == spec::Scalar::float64);
  });
}

/// The runtime looks through the fields for numbers that are not finite.
std::string fields_of(const spec::Structure& structure_) {
  std::vector<std::string> members;
  for (const spec::Field& field : structure_.fields)
    members.push_back(fmt::format("&{}::{}", structure_.name, field.name));
  return member_function(fmt::format("friend auto fields_of(const {}&)", structure_.name),
                         {fmt::format("return std::tuple({});", fmt::join(members, ", "))});
}

std::string definition(const Project& project, const spec::Structure& structure_) {
  std::set<std::string_view> hidden{structure_.name};
  for (const spec::Field& field : structure_.fields) hidden.insert(field.name);
  std::vector<Declaration> fields;
  for (const spec::Field& field : structure_.fields)
    fields.push_back({fmt::format("{} {}{{}};", type_name(project.model, field.type, hidden), field.name),
                      comment_text(field.type.unit)});
  std::string tail = fmt::format("\n  bool operator==(const {}&) const = default;\n", structure_.name);
  if (has_floats(project.model, structure_)) tail += fields_of(structure_);
  return fmt::format("\n/// {}\n{}", project.at(structure_.span), structure(structure_.name, fields, tail));
}

}  // namespace

File types_header(const Project& project) {
  std::set<std::string> headers;
  if (std::ranges::any_of(project.model.structures,
                          [&](const auto& one) { return has_floats(project.model, one); }))
    headers.insert("<tuple>");
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
