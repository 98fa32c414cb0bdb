#include "spec/conditions/check.hpp"

#include "spec/conditions/operators.hpp"

namespace tessera::spec {
namespace {

/// An expression with more tokens was not written by hand, and is left to the compiler.
constexpr std::size_t most_tokens = 4096;

}  // namespace

void check_expression(Expression& expression, const Node& text, const ConditionScope& scope,
                      const std::vector<std::string>& others, Diagnostics& out) {
  const std::vector<Token> tokens = tokens_of(text.text);
  if (tokens.size() > most_tokens) return;
  const Positions positions(text, out);
  const std::size_t errors = out.error_count();
  const ConditionNames names(tokens, positions, scope, others, out);
  expression.references = names.references();
  if (names.declares_names() || out.error_count() != errors) return;
  ConditionOperators operators(tokens, positions, scope, names, text.text, out);
  operators.check();
  expression.times = operators.times();
  const std::size_t blanks = text.text.find_first_not_of(" \t\r\n");  // which the expression is without
  for (Expression::TimeNumber& number : expression.times) {
    number.begin -= blanks;
    number.end -= blanks;
  }
}

}  // namespace tessera::spec
