#pragma once

#include <string>
#include <vector>

#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"

namespace tessera::spec {

/// Reads the expression of a condition as far as the specification can judge it, and fills in its references.
/// Legal C++ that it does not understand is left to the compiler.
///
/// text:   the scalar that the expression was read from.
/// others: names of conditions, which an expression cannot name.
/// Errors: E101 a name that does not exist; E204 an element that an array does not have; E209 an operator is
///         missing or misspelt; E212 operands that do not go together, or no truth value.
/// Warnings: W325 numbers of different units; W326 a number as true or false.
void check_expression(Expression& expression, const Node& text, const ConditionScope& scope,
                      const std::vector<std::string>& others, Diagnostics& out);

}  // namespace tessera::spec
