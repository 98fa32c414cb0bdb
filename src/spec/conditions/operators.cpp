#include "spec/conditions/operators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Is = Value::Kind;

/// Brackets may be nested so deep; what is deeper is left to the compiler.
constexpr int deepest_brackets = 200;

struct Binding {
  std::string_view mark;
  int strength;
};
constexpr std::array bindings = std::to_array<Binding>(
    {{"?", 1},  {"||", 2},  {"or", 2}, {"&&", 3},     {"and", 3}, {"|", 4},  {"bitor", 4},
     {"^", 5},  {"xor", 5}, {"&", 6},  {"bitand", 6}, {"==", 7},  {"!=", 7}, {"not_eq", 7},
     {"<", 8},  {">", 8},   {"<=", 8}, {">=", 8},     {"<<", 9},  {">>", 9}, {"+", 10},
     {"-", 10}, {"*", 11},  {"/", 11}, {"%", 11}});
constexpr int assignment = 0;

/// Whether an operand begins here, so that an operator is missing before it.
bool begins_operand(const Token& token) {
  if (token.kind == Token::Kind::name)
    return !is_keyword(token.text) || token.text == "true" || token.text == "false";
  return token.kind == Token::Kind::number || token.kind == Token::Kind::duration ||
         token.kind == Token::Kind::text || token.kind == Token::Kind::quantity;
}

}  // namespace

ConditionOperators::ConditionOperators(const std::vector<Token>& tokens, const Positions& positions,
                                       const ConditionScope& scope, const ConditionNames& names,
                                       std::string_view text, Diagnostics& out)
    : tokens_(tokens), positions_(positions), scope_(scope), names_(names), text_(text), out_(out) {}

void ConditionOperators::check() {
  const Value whole = read(assignment);
  const bool is_whole = token().kind == Token::Kind::end;
  if (!given_up_ && !is_whole) misspelt();
  if (given_up_) return;
  if (is_whole) need_truth(whole, "a condition");
  for (Mistake& one : mistakes_) {
    if (one.warning)
      out_.warning(std::move(one.code), one.span, std::move(one.message), std::move(one.hint));
    else
      out_.error(std::move(one.code), one.span, std::move(one.message), std::move(one.hint));
  }
}

Value ConditionOperators::give_up() {
  given_up_ = true;
  at_ = tokens_.size() - 1;
  return {};
}

/// The expression is understood up to here, and something else than an operator follows.
void ConditionOperators::misspelt() {
  if (token().is("=>") || token().is("=<")) {
    mistake_at(token(), "E209", in_quotes(token().text) + " is no operator",
               token().is("=>") ? "write >=" : "write <=");
  } else if (at_ > 0 && begins_operand(token()) && !tokens_[at_ - 1].is(")")) {
    // "and" and "or" in words are operators of C++, others are not.
    mistake_at(token(), "E209", "an operator is missing before " + in_quotes(token().text),
               token().is("is") ? "compare with ==" : "join two conditions by && or ||");
  } else {
    give_up();
  }
}

int ConditionOperators::binding() const {
  if (token().kind != Token::Kind::mark && token().kind != Token::Kind::name) return -1;
  const auto found = std::ranges::find(bindings, token().text, &Binding::mark);
  return found == bindings.end() ? -1 : found->strength;
}

Value ConditionOperators::read(int least) {
  if (++depth_ > deepest_brackets) return give_up();
  Value left = read_operand();
  for (int strength = binding(); !given_up_ && strength > least; strength = binding()) {
    const Token& mark = token();
    ++at_;
    if (mark.is("?")) {
      left = choose(left);
      continue;
    }
    const Value right = read(strength);
    if (given_up_) break;
    Value both = combine(mark, left, right);
    both.begin = left.begin;
    both.end = right.end;
    left = both;
  }
  --depth_;
  if (given_up_) return {};
  const bool assigns = token().is_one_of({"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^="});
  if (assigns && least <= assignment && left.declared) {
    mistake_at(token(), "E209", "a condition changes nothing, but " + in_quotes(token().text) + " assigns",
               token().is("=") ? "write == to compare" : "a transition function can change memory");
    ++at_;
    read(assignment);
    return {};
  }
  return assigns ? give_up() : left;
}

/// Behind the "?".
Value ConditionOperators::choose(const Value& condition) {
  need_truth(condition, "what stands before '?'");
  const Value first = read(assignment);
  if (given_up_ || !token().is(":")) return give_up();
  ++at_;
  const Value second = read(assignment);
  Value chosen = first.kind == second.kind ? first : Value{};
  if (first.time_unit != second.time_unit) chosen.time_unit.clear();
  for (const auto& [one, other] : {std::pair{first, second}, std::pair{second, first}}) {
    if (one.kind != Is::duration || other.time_unit.empty()) continue;
    as_duration(other);
    chosen.kind = Is::duration;
  }
  chosen.declared = false;
  chosen.begin = condition.begin;
  chosen.end = second.end;
  return chosen;
}

Value ConditionOperators::read_operand() {
  const Token& first = token();
  Value value;
  value.begin = first.position;
  value.end = first.position + first.text.size();
  switch (first.kind) {
    case Token::Kind::number:
    case Token::Kind::duration:
    case Token::Kind::quantity:
      ++at_;
      value.kind = first.kind == Token::Kind::duration ? Is::duration : Is::number;
      value.literal = true;
      if (first.kind == Token::Kind::quantity) {
        const auto si = in_si(*split_quantity(first.text));
        mistake("E212", value, "a number in a condition has no unit, unless it is a duration",
                si ? fmt::format("write the number alone: {} if it is in {}", si->number, si->unit) : "");
        value.kind = Is::unknown;
      }
      return read_postfix(value);
    case Token::Kind::text:
      ++at_;
      return read_postfix(value);
    case Token::Kind::name:
      return read_name();
    case Token::Kind::mark:
      return first.is("(") ? read_brackets() : read_prefix();
    case Token::Kind::end:
      break;
  }
  return give_up();
}

Value ConditionOperators::read_prefix() {
  const Token& mark = token();
  if (!mark.is_one_of({"!", "not", "-", "+", "~"})) return give_up();
  ++at_;
  Value value = read(11);  // binds closer than every operator between two operands
  if (given_up_) return {};
  if (mark.is("!") || mark.is("not")) {
    need_truth(value, in_quotes(mark.text));
    value = Value{Is::boolean, false, false, false, {}, mark.position, value.end};
  } else if (value.is_compound() || value.kind == Is::time) {
    mistake("E212", value, in_quotes(mark.text) + " needs a number; " + described(value));
    value.kind = Is::unknown;
  } else {
    value.kind = value.kind == Is::boolean ? Is::number : value.kind;
    value.begin = mark.position;
  }
  return value;
}

Value ConditionOperators::read_brackets() {
  const std::size_t begin = token().position;
  ++at_;
  Value value = read(assignment);
  if (given_up_ || !token().is(")")) return give_up();
  value.begin = begin;
  value.end = token().position + 1;
  value.comparison = false;
  ++at_;
  if (begins_operand(token()) || token().is("(")) return give_up();  // a cast
  return read_postfix(value);
}

Value ConditionOperators::read_name() {
  const Token& name = token();
  if (name.is("not")) return read_prefix();
  if (const ConditionNames::Chain* chain = names_.chain_at(at_)) {
    at_ = chain->end;
    return read_postfix(chain->value);
  }
  if (is_keyword(name.text)) {
    // static_cast<double>(...) is the only one that is read.
    if (!name.is("static_cast") || !tokens_[at_ + 1].is("<")) return give_up();
    while (token().kind != Token::Kind::end && !token().is(">")) ++at_;
    if (!token().is(">") || !tokens_[at_ + 1].is("(")) return give_up();
  }
  Value value;
  value.begin = name.position;
  ++at_;
  while (token().is("::") && tokens_[at_ + 1].kind == Token::Kind::name) at_ += 2;
  if (token().is("::") || token().is("{") || token().is("<")) return give_up();  // a template, perhaps
  value.end = tokens_[at_ - 1].position + tokens_[at_ - 1].text.size();
  return read_postfix(value);
}

/// Calls, members and subscripts of something that is left to the compiler.
Value ConditionOperators::read_postfix(Value value) {
  for (;;) {
    if (token().is("(") || token().is("[")) {
      read_arguments();
    } else if ((token().is(".") || token().is("->")) && tokens_[at_ + 1].kind == Token::Kind::name) {
      at_ += 2;
    } else {
      break;
    }
    if (given_up_) return {};
    value = Value{Is::unknown,
                  false,
                  false,
                  false,
                  {},
                  value.begin,
                  tokens_[at_ - 1].position + tokens_[at_ - 1].text.size()};
  }
  return token().is("++") || token().is("--") ? give_up() : value;
}

void ConditionOperators::read_arguments() {
  const std::string_view closing = token().is("(") ? ")" : "]";
  ++at_;
  while (!given_up_ && !token().is(closing)) {
    static_cast<void>(read(assignment));
    if (token().is(","))
      ++at_;
    else if (!token().is(closing))
      give_up();
  }
  if (!given_up_) ++at_;
}

}  // namespace tessera::spec
