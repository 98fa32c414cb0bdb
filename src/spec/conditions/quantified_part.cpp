#include "spec/conditions/quantified_part.hpp"

#include <algorithm>
#include <charconv>

namespace tessera::spec {
namespace {

/// "( in . request . fresh )" behind the word.
constexpr std::size_t length_of_call = 8;

std::int64_t number_of_token(const Token& token) {
  std::int64_t number = 0;
  std::from_chars(token.text.data(), token.text.data() + token.text.size(), number);
  return number;
}

bool fits(std::int64_t count, const Token& mark, std::int64_t other) {
  if (mark.is("==")) return count == other;
  if (mark.is_one_of({"!=", "not_eq"})) return count != other;
  if (mark.is("<")) return count < other;
  if (mark.is("<=")) return count <= other;
  return mark.is(">") ? count > other : count >= other;
}

/// The token behind the bracket that closes the one at a token.
std::size_t behind(const std::vector<Token>& tokens, std::size_t at) {
  int depth = 0;
  for (; tokens[at].kind != Token::Kind::end; ++at) {
    if (tokens[at].is("(")) ++depth;
    if (tokens[at].is(")") && --depth == 0) return at;
  }
  return at;
}

}  // namespace

Truth QuantifiedPart::truth(const std::vector<Truth>& members) const {
  const auto least = static_cast<std::int64_t>(std::ranges::count(members, Truth::always));
  const auto most = least + static_cast<std::int64_t>(std::ranges::count(members, Truth::free));
  const auto all = static_cast<std::int64_t>(members.size());
  bool sometimes = false, always = true;
  for (std::int64_t count = least; count <= most; ++count) {
    const bool holds = word.front().is("all") ? count == all
                       : compared.empty()     ? count > 0
                                              : fits(count, compared[0], number_of_token(compared[1]));
    sometimes = sometimes || holds;
    always = always && holds;
  }
  if (always) return Truth::always;
  return sometimes ? Truth::free : Truth::never;
}

std::optional<QuantifiedPart> quantified_part(std::span<const Token> part) {
  const bool is_call = part.size() >= length_of_call && part[0].is_one_of({"any", "all", "count"}) &&
                       part[1].is("(") && part[2].is_one_of({"in", "out"}) && part[3].is(".") &&
                       part[4].kind == Token::Kind::name && part[5].is(".") &&
                       part[6].kind == Token::Kind::name && part[7].is(")");
  if (!is_call) return std::nullopt;
  QuantifiedPart found{part.first(1), std::string(part[2].text), std::string(part[4].text),
                       std::string(part[6].text)};
  if (part.size() == length_of_call) return found;
  const bool compares = part.size() == length_of_call + 2 && part[0].is("count") &&
                        part[8].is_one_of({"==", "!=", "not_eq", "<", "<=", ">", ">="}) &&
                        part[9].kind == Token::Kind::number &&
                        part[9].text.find_first_not_of("0123456789") == std::string_view::npos;
  if (!compares) return std::nullopt;
  found.compared = part.subspan(length_of_call, 2);
  return found;
}

std::string with_cpp_quantifiers(std::string expression, const std::vector<std::string>& families) {
  if (families.empty()) return expression;
  const std::vector<Token> tokens = tokens_of(expression);
  std::string result = expression;
  for (std::size_t at = tokens.size(); at-- > 0;) {
    if (!tokens[at].is_one_of({"any", "all", "count", "which"}) || at + 5 >= tokens.size()) continue;
    const bool fits = tokens[at + 1].is("(") && tokens[at + 2].is_one_of({"in", "out"}) &&
                      tokens[at + 3].is(".") && std::ranges::count(families, tokens[at + 4].text) > 0;
    if (!fits || (at > 0 && tokens[at - 1].is_one_of({".", "->", "::"}))) continue;
    const std::size_t end = tokens[behind(tokens, at + 1)].position;
    const std::size_t rest = tokens[at + 4].position + tokens[at + 4].text.size();
    const std::string buffers = std::string(tokens[at + 2].text) + "." + std::string(tokens[at + 4].text);
    result.replace(tokens[at].position, end - tokens[at].position,
                   "tessera::" + std::string(tokens[at].text) + "(" + buffers +
                       ", [](const auto& tessera_one) { return static_cast<bool>(tessera_one" +
                       expression.substr(rest, end - rest) + "); }");
  }
  return result;
}

}  // namespace tessera::spec
