// Elements of arrays, and what stands behind a name.

#include <charconv>

#include "spec/conditions/names.hpp"

namespace tessera::spec {
namespace {

using Is = Value::Kind;

}  // namespace

/// At "[". false: there is no such element, which has been reported.
bool ConditionNames::read_subscript(std::size_t& at, Value& value, const std::string& path) {
  if (value.kind == Is::text) return false;  // left to the compiler
  const Token& open = tokens_[at];
  if (value.kind != Is::array) {
    out_.error("E212", span_of(open), path + " has no elements: it is " + in_words(value, scope_.types));
    return false;
  }
  const bool is_negative = tokens_[at + 1].is("-");
  const Token* const number = &tokens_[at + (is_negative ? 2 : 1)];
  std::uint64_t element = 0;
  const char* const end = number->text.data() + number->text.size();
  const bool is_constant = number->kind == Token::Kind::number && number[1].is("]") &&
                           !(number->text.size() > 1 && number->text.front() == '0') &&
                           std::from_chars(number->text.data(), end, element).ptr == end;
  if (is_constant && (element >= value.type.extent || (is_negative && element > 0)))
    out_.error("E204", span_of(*number),
               path + " has no element " + (is_negative ? "-" : "") + std::string(number->text) + ": it is " +
                   in_words(value, scope_.types),
               "elements count from 0: the last one is " + std::to_string(value.type.extent - 1));
  at = behind_bracket(at);
  value = value_of(value.type.element());
  return true;
}

std::size_t ConditionNames::behind_bracket(std::size_t at) const {
  int depth = 0;
  for (; tokens_[at].kind != Token::Kind::end; ++at) {
    if (tokens_[at].kind != Token::Kind::mark) continue;
    if (tokens_[at].is("(") || tokens_[at].is("[") || tokens_[at].is("{")) ++depth;
    if (tokens_[at].is(")") || tokens_[at].is("]") || tokens_[at].is("}")) --depth;
    if (depth == 0) return at + 1;
  }
  return at;
}

std::size_t ConditionNames::skip_chain(std::size_t at) const {
  for (;;) {
    if (tokens_[at].is("(") || tokens_[at].is("["))
      at = behind_bracket(at);
    else if ((tokens_[at].is(".") || tokens_[at].is("->") || tokens_[at].is("::")) &&
             tokens_[at + 1].kind == Token::Kind::name)
      at += 2;
    else
      return at;
  }
}

}  // namespace tessera::spec
