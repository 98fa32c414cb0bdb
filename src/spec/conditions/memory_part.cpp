#include "spec/conditions/memory_part.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace tessera::spec {
namespace {

using Tokens = std::span<const Token>;

bool is_comparison(const Token& token) {
  return token.is_one_of({"==", "!=", "not_eq", "<", "<=", ">", ">="});
}

/// "lent_to" of "memory.lent_to"; empty: the tokens are something else.
std::string_view cell_in(Tokens tokens) {
  const bool fits = tokens.size() == 3 && tokens[0].is("memory") && tokens[1].is(".") &&
                    tokens[2].kind == Token::Kind::name;
  return fits ? tokens[2].text : std::string_view{};
}

template <class Number>
bool compares(const Token& mark, Number left, Number right) {
  if (mark.is("==")) return left == right;
  if (mark.is_one_of({"!=", "not_eq"})) return left != right;
  if (mark.is("<")) return left < right;
  if (mark.is("<=")) return left <= right;
  return mark.is(">") ? left > right : left >= right;
}

/// A decimal number: 3, 1.5, 2u.
std::optional<double> decimal_in(const Token& token) {
  double number = 0;
  std::string_view text = token.text;
  while (!text.empty() && std::string_view("uUlLfF").find(text.back()) != std::string_view::npos)
    text.remove_suffix(1);
  const bool octal = text.size() > 1 && text.front() == '0' && text[1] != '.';
  if (token.kind != Token::Kind::number || octal) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && stop == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::optional<std::uint32_t> number_in(const Token& token) {
  const std::optional<double> number = decimal_in(token);
  const bool whole = number && *number >= 0 && *number <= 1e9 &&
                     token.text.find_first_not_of("0123456789") == std::string_view::npos;
  return whole ? std::optional(static_cast<std::uint32_t>(*number)) : std::nullopt;
}

/// The position of a value that is written as "nobody", "Memory::LentTo::nobody", "robot[2]" or "robot[i]". The
/// compiler judges the name of the enumeration.
std::optional<double> value_in(const FewValues& few, Tokens constant, std::optional<std::uint32_t> member) {
  if (constant.front().kind != Token::Kind::name) return std::nullopt;
  const bool in_full = constant.size() == 5 && constant[0].is("Memory") && constant[1].is("::") &&
                       constant[2].kind == Token::Kind::name && constant[3].is("::");
  if (in_full) constant = constant.last(1);
  if (constant.size() == 1) {
    const auto found = few.find(constant.front().text);
    return found ? std::optional<double>(*found) : std::nullopt;
  }
  const auto number = index_at_end(constant, member);
  if (!number || constant.size() != 4 || constant.front().text != few.fleet || *number >= few.member_count)
    return std::nullopt;
  return static_cast<double>(few.first_member) + *number;
}

/// Per value of the cell, whether it fits; empty: the constant is none that the net knows.
std::vector<bool> fitting(const FewValues& few, const Token& mark, Tokens constant, bool is_left,
                          std::optional<std::uint32_t> member) {
  std::optional<double> other = constant.size() == 1 ? decimal_in(constant.front()) : std::nullopt;
  if (!few.counts) {
    other = value_in(few, constant, member);
    if (!mark.is_one_of({"==", "!=", "not_eq"})) return {};
  }
  std::vector<bool> holds;
  for (std::uint32_t value = 0; other && value < few.names.size(); ++value) {
    const double mine = few.counts ? static_cast<double>(few.least) + value : value;
    holds.push_back(is_left ? compares(mark, *other, mine) : compares(mark, mine, *other));
  }
  return holds;
}

}  // namespace

std::optional<std::uint32_t> index_at_end(Tokens tokens, std::optional<std::uint32_t> member) {
  if (tokens.size() < 3) return std::nullopt;
  const Tokens brackets = tokens.last(3);
  if (!brackets[0].is("[") || !brackets[2].is("]")) return std::nullopt;
  if (brackets[1].is("i")) return member;
  const auto number = number_in(brackets[1]);
  return number;
}

std::optional<MemoryPart> memory_part(Tokens part, const std::vector<Field>& memory,
                                      std::optional<std::uint32_t> member) {
  if (part.size() != 3 && part.size() != 5 && part.size() != 8 && part.size() != 9) return std::nullopt;
  // The constant is one token, four: robot [ i ], or five: Memory :: LentTo :: nobody.
  const std::size_t constant = part.size() - 4;
  const bool is_left = part.size() > 3 && is_comparison(part[constant]);
  const std::string_view name = cell_in(is_left ? part.last(3) : part.first(3));
  const auto cell = std::ranges::find(memory, name, &Field::name);
  if (name.empty() || cell == memory.end() || !cell->few) return std::nullopt;
  MemoryPart found{static_cast<std::uint32_t>(cell - memory.begin()), {}};
  if (part.size() == 3) {
    for (std::uint32_t value = 0; cell->few->counts && value < cell->few->names.size(); ++value)
      found.holds.push_back(cell->few->least + value != 0);
  } else {
    const Token& mark = is_left ? part[constant] : part[3];
    if (is_comparison(mark))
      found.holds =
          fitting(*cell->few, mark, is_left ? part.first(constant) : part.last(constant), is_left, member);
  }
  return found.holds.empty() ? std::nullopt : std::optional(std::move(found));
}

}  // namespace tessera::spec
