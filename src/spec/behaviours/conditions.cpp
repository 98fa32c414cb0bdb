#include "spec/behaviours/conditions.hpp"

#include <algorithm>
#include <array>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/check.hpp"
#include "spec/document/expression_text.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Words with a special meaning in `when` or `next`.
constexpr std::array reserved = std::to_array<std::string_view>({"error", "terminal", "end"});

constexpr const char* condition_hint =
    "write true, an expression such as in.line.left, or a map of named expressions";

/// A constant in quotes is text in YAML, but the same constant in C++.
std::optional<bool> quoted_constant(const Node& node) {
  if (!node.is_scalar() || !node.quoted) return std::nullopt;
  const std::size_t first = node.text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return std::nullopt;
  const std::string_view text =
      std::string_view(node.text).substr(first, node.text.find_last_not_of(" \t\r\n") - first + 1);
  if (text == "true" || text == "false") return text == "true";
  return std::nullopt;
}

void warn_of_quotes(const Node& node, Diagnostics& out) {
  const std::optional<bool> known = quoted_constant(node);
  if (!known) return;
  const std::string word = *known ? "true" : "false";
  out.warning("W322", node.span, "this condition is always " + word,
              "write " + word + " without quotes if that is meant");
}

/// The truth of a constant, however it is written.
std::optional<bool> constant(const Node& node) {
  if (is_true(node) || is_false(node)) return is_true(node);
  return quoted_constant(node);
}

/// The text of an expression; nullptr: there is none to check.
const Node* read_expression(const Node& node, Span at, Expression& expression, Diagnostics& out) {
  expression.span = at;
  const Node* text = text_of(node, at, "a condition", out, condition_hint);
  if (text == nullptr) return nullptr;
  const bool is_old = is_old_boolean(*text);
  if (is_old)
    out.error("E104", text->span, in_quotes(text->text) + " is no condition", "write true or false");
  expression.span = text->span;
  warn_of_quotes(*text, out);
  const std::optional<bool> known = constant(*text);
  const std::size_t errors = out.error_count();
  expression.text = known ? (*known ? "true" : "false") : expression_text(*text, out);
  return known || is_old || out.error_count() > errors ? nullptr : text;
}

Expression checked_expression(const Node& node, Span at, std::string name, const ConditionScope& scope,
                              const std::vector<std::string>& others, Diagnostics& out) {
  Expression expression{std::move(name), {}, at};
  if (scope.member != nullptr) expression.member = scope.member->number;
  if (const Node* text = read_expression(node, at, expression, out))
    check_expression(expression, *text, scope, others, out);
  return expression;
}

void check_condition_name(const Entry& entry, Diagnostics& out) {
  check_name(entry.key, entry.span, "condition", out);
  if (std::find(reserved.begin(), reserved.end(), entry.key) != reserved.end())
    out.error("E106", entry.span, "condition name " + in_quotes(entry.key) + " is reserved");
}

/// A key without a value: the condition of the subsystem that has this name.
void read_shared(const Entry& entry, Condition& result, SharedConditions& shared, Diagnostics& out) {
  if (const Expression* one = shared.use(entry.key)) {
    result.expressions.push_back(*one);
    return;
  }
  out.error("E101", entry.span, "the subsystem has no condition " + in_quotes(entry.key),
            did_you_mean(entry.key, shared.names()));
  result.expressions.push_back({{}, {}, entry.span});
}

/// The line of the condition of the subsystem that has the name, too.
void complain_about_shared(const Entry& entry, const Expression& one, Diagnostics& out) {
  out.error(
      "E107", entry.span, "condition " + in_quotes(entry.key) + " is one of the subsystem already",
      "the first is on " + out.words(one.span.line) + "; " + entry.key + " without an expression names it");
}

void read_named(const Entry& condition, Condition& result, const ConditionScope& scope,
                SharedConditions& shared, Diagnostics& out) {
  std::vector<std::string> names = shared.names();
  for (const Entry& entry : condition.value->entries) names.push_back(entry.key);
  if (condition.value->entries.empty()) {
    out.error("E104", condition.span, in_quotes(condition.key) + " needs at least one named expression",
              condition_hint);
    // an unknown condition, so that no further mistake follows from it
    result.expressions.push_back({{}, {}, condition.span});
  }
  for (const Entry& entry : condition.value->entries) {
    if (entry.value->is_null() && !shared.all.empty()) {
      read_shared(entry, result, shared, out);
      continue;
    }
    check_condition_name(entry, out);
    if (const Expression* one = shared.use(entry.key)) complain_about_shared(entry, *one, out);
    result.expressions.push_back(checked_expression(*entry.value, entry.span, entry.key, scope, names, out));
  }
}

ExpressionId expression_named(const Condition& condition, std::string_view name) {
  for (const ExpressionId i : condition.expressions.ids()) {
    if (condition.expressions[i].name == name) return i;
  }
  return {};
}

std::vector<std::string> names_of_conditions(const Behaviour& of) {
  std::vector<std::string> names{"error"};
  for (const Condition* condition : {&of.terminal, &of.error}) {
    for (const Expression& one : condition->expressions) {
      if (!one.name.empty()) names.push_back(one.name);
    }
  }
  return names;
}

/// The hint for a single word that names no condition.
Hint hint_for(const std::string& word, const Behaviour& of, const SharedConditions& shared) {
  const std::vector<std::string> all = shared.names();
  if (std::find(all.begin(), all.end(), word) != all.end())
    return "name it under 'terminal' or 'error' of this behaviour, too: only what has ended it can be asked";
  if (word == "until") return "a group with 'until' has it: 'next' of that group may ask it";
  if (word == "terminal") return "leave 'when' out: such an entry is taken when the behaviour is terminal";
  const std::vector<std::string> names = names_of_conditions(of);
  const Hint guess = did_you_mean(word, names);
  return guess.empty() ? "name it under 'terminal' or 'error', or write an expression such as in.line.left"
                       : guess;
}

/// The condition of the subsystem that a single word probably means; empty: it means none.
Hint misspelt_name(const Node& value, const SharedConditions& shared) {
  if (!value.is_scalar() || !is_identifier(value.text) || value.text == "elapsed" || value.text == "index")
    return {};
  return did_you_mean(value.text, shared.names());
}

}  // namespace

SharedConditions read_shared_conditions(const Entry* entry, const ConditionScope& scope, Diagnostics& out) {
  SharedConditions shared;
  if (entry == nullptr) return shared;
  const std::vector<Entry>& entries = entries_of(*entry->value, entry->span, "conditions", out);
  std::vector<std::string> names;
  for (const Entry& one : entries) names.push_back(one.key);
  for (const Entry& one : entries) {
    const std::size_t errors = out.error_count();
    check_condition_name(one, out);
    shared.all.push_back(checked_expression(*one.value, one.span, one.key, scope, names, out));
    shared.used.push_back(out.error_count() > errors);  // then nothing more is said about it
  }
  return shared;
}

Condition read_condition(const Entry* entry, const ConditionScope& scope, SharedConditions& shared,
                         Diagnostics& out) {
  Condition condition;
  if (entry == nullptr) return condition;
  const Node& value = *entry->value;
  condition.span = value.is_scalar() ? value.span : entry->span;
  if (const std::optional<bool> known = constant(value)) {
    warn_of_quotes(value, out);
    condition.kind = *known ? Condition::Kind::always : Condition::Kind::never;
    return condition;
  }
  condition.kind = Condition::Kind::expressions;
  if (value.is_map()) {
    read_named(*entry, condition, scope, shared, out);
  } else if (const Expression* one = value.is_scalar() ? shared.use(value.text) : nullptr) {
    condition.expressions.push_back(*one);
  } else if (const Hint guess = misspelt_name(value, shared); !guess.empty()) {
    out.error("E101", value.span, "unknown condition " + in_quotes(value.text), guess);
    condition.expressions.push_back({{}, {}, value.span});
  } else {
    condition.expressions.push_back(checked_expression(value, entry->span, {}, scope, shared.names(), out));
  }
  return condition;
}

When read_when(const Entry& entry, const Behaviour& of, const ConditionScope& scope,
               const SharedConditions& shared, Diagnostics& out) {
  When when;
  Expression expression;
  if (scope.member != nullptr) expression.member = scope.member->number;
  const Node* text = read_expression(*entry.value, entry.span, expression, out);
  when.text.span = expression.span;
  const std::string& word = expression.text;
  if (const std::optional<bool> known = constant(*entry.value)) {
    when.kind = *known ? When::Kind::always : When::Kind::never;
  } else if (word == "error") {
    when.kind = When::Kind::error;
  } else if (const auto terminal = expression_named(of.terminal, word); terminal.valid() && !word.empty()) {
    when.kind = When::Kind::terminal;
    when.expression = terminal;
  } else if (const auto error = expression_named(of.error, word); error.valid() && !word.empty()) {
    when.kind = When::Kind::named_error;
    when.expression = error;
  } else if (is_identifier(word) && !is_old_boolean(*entry.value)) {
    out.error("E101", expression.span, "unknown condition " + in_quotes(word), hint_for(word, of, shared));
    when.kind = When::Kind::expression;
  } else {
    when.kind = When::Kind::expression;
    if (text != nullptr) check_expression(expression, *text, scope, names_of_conditions(of), out);
    when.text = std::move(expression);
  }
  return when;
}

}  // namespace tessera::spec
