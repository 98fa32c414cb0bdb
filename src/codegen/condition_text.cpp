#include "codegen/condition_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/cpp_text.hpp"
#include "spec/conditions/quantified_part.hpp"
#include "spec/conditions/tokens.hpp"

namespace tessera::codegen {

std::string at_column(const spec::Expression& expression, std::uint32_t column,
                      const std::vector<std::string>& families) {
  const std::string indent(column - 1, ' ');
  const std::string text = spec::with_cpp_quantifiers(condition_text(expression), families);
  std::string out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (begin > 0) out += '\n';
    if (end > begin) out += indent + text.substr(begin, end - begin);
    begin = end + 1;
  }
  return out;
}

std::vector<std::string> buffer_families(const spec::Subsystem& subsystem) {
  std::vector<std::string> names;
  for (const auto* buffers : {&subsystem.inputs, &subsystem.outputs})
    for (const spec::Field& field : *buffers)
      if (field.member && field.member->number == 0) names.push_back(field.member->family);
  return names;
}

bool calls_library(const spec::Expression& expression) {
  const std::vector<spec::Token> tokens = spec::tokens_of(expression.text);
  for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
    if (tokens[at].kind != spec::Token::Kind::name) continue;
    if (tokens[at].is("std") && !tokens[at + 2].is("chrono")) return true;
    const bool is_call =
        tokens[at + 1].is("(") && !tokens[at].is_one_of({"and", "or", "not", "any", "all", "count", "which"});
    if (is_call && (at == 0 || !tokens[at - 1].is_one_of({".", "->", "::"}))) return true;
  }
  return false;
}

std::string allowed_text(const spec::Subsystem& subsystem, const spec::Next& entry) {
  std::string text;
  const auto add = [&text](const std::string& one) { text += (text.empty() ? "" : " && ") + one; };
  for (std::uint32_t number = 0; entry.may_be_blocked && number < subsystem.memory.size(); ++number) {
    const spec::Field& cell = subsystem.memory[number];
    if (!cell.few || !cell.few->counts) continue;
    const auto counts = spec::allowed(*cell.few, number, entry.sets);
    if (counts && counts->first > 0)
      add(fmt::format("memory.{} >= {}", cell.name, cell.few->names[counts->first]));
    if (counts && counts->last + 1 < cell.few->names.size())
      add(fmt::format("memory.{} <= {}", cell.name, cell.few->names[counts->last]));
  }
  return text;
}

}  // namespace tessera::codegen
