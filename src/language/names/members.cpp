#include <algorithm>

#include "language/names/index.hpp"

namespace tessera::language {
namespace {

bool token_is(const std::vector<Token>& tokens, std::size_t at, std::string_view text) {
  return at < tokens.size() && tokens[at].text == text;
}

bool is_access(const std::vector<Token>& tokens, std::size_t at) {
  return token_is(tokens, at, ".") || token_is(tokens, at, "->");
}

/// Behind the index that stands at `at`, if one does.
std::size_t behind_index(const std::vector<Token>& tokens, std::size_t at) {
  while (token_is(tokens, at, "[")) {
    int depth = 0;
    for (; at < tokens.size(); ++at) {
      if (tokens[at].text == "[") ++depth;
      if (tokens[at].text == "]" && --depth == 0) break;
    }
    if (at < tokens.size()) ++at;
  }
  return at;
}

}  // namespace

std::optional<NamesOf> Index::members(const UnitNames& unit, std::string_view base) const {
  const auto joined = [](NamesOf first, const NamesOf& second) {
    first.insert(second.begin(), second.end());
    return first;
  };
  if (base == "in")
    return unit.role == SubsystemRole::receptor ? joined(unit.inputs, unit.real) : unit.inputs;
  if (base == "out")
    return unit.role == SubsystemRole::effector ? joined(unit.outputs, unit.real) : unit.outputs;
  if (base == "memory") return unit.memory;
  if (base == "parameters") return joined(unit.parameters, parameters_);
  return std::nullopt;
}

void resolve_members(const Index& index, const UnitNames& unit, const std::vector<Token>& tokens,
                     const FoundUse& found) {
  for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
    if (tokens[at].kind != Token::Kind::name || !is_access(tokens, at + 1)) continue;
    const bool member = at > 0 && (is_access(tokens, at - 1) || tokens[at - 1].text == "::");
    // context.parameters is the only member that is known by its name alone.
    if (member && !(tokens[at].text == "parameters" && at > 1 && tokens[at - 2].text == "context")) continue;
    const std::string_view base = tokens[at].text;
    if (base != "in" && base != "out" && base != "memory" && base != "parameters") continue;
    const std::optional<NamesOf> members = index.members(unit, base);
    const auto first = members->find(tokens[at + 2].text);
    if (first == members->end()) continue;
    SymbolId symbol = first->second;
    found(tokens[at + 2].extent, symbol);
    std::size_t next = behind_index(tokens, at + 3);
    while (is_access(tokens, next) && next + 1 < tokens.size()) {
      const NamesOf* fields = index.fields_of(index[symbol].type);
      if (fields == nullptr) break;
      const auto field = fields->find(tokens[next + 1].text);
      if (field == fields->end()) break;
      symbol = field->second;
      found(tokens[next + 1].extent, symbol);
      next = behind_index(tokens, next + 2);
    }
  }
}

void resolve_values(const UnitNames& unit, const std::vector<Token>& tokens, const FoundUse& found) {
  const auto is_name = [&](std::size_t at) {
    return at < tokens.size() && tokens[at].kind == Token::Kind::name && !is_access(tokens, at + 1) &&
           (at == 0 || !is_access(tokens, at - 1));
  };
  // "==" and "!=" are two tokens each.
  const auto compares = [&](std::size_t at) {
    return (token_is(tokens, at, "=") || token_is(tokens, at, "!")) && token_is(tokens, at + 1, "=");
  };
  for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
    if (tokens[at].text != "memory" || tokens[at + 1].text != "." || (at > 0 && is_access(tokens, at - 1)))
      continue;
    const auto cell = unit.values.find(tokens[at + 2].text);
    if (cell == unit.values.end()) continue;
    const auto use = [&](std::size_t word) {
      if (!is_name(word)) return;
      const auto value = cell->second.find(tokens[word].text);
      if (value != cell->second.end()) found(tokens[word].extent, value->second);
    };
    if (token_is(tokens, at + 3, "not_eq")) use(at + 4);
    if (compares(at + 3)) use(at + 5);
    if (at > 1 && token_is(tokens, at - 1, "not_eq")) use(at - 2);
    if (at > 2 && compares(at - 2)) use(at - 3);
  }
}

}  // namespace tessera::language
