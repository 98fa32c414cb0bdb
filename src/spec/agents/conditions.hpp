#pragma once

#include <optional>

#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// A `terminal` or `error` condition. entry may be null: the condition never holds.
///
/// Errors: E104 neither bool nor text nor map; E105/E106/E107 names of expressions; E209 no C++ expression;
///         those of check_expression.
[[nodiscard]] Condition read_condition(const Entry* entry, const ConditionScope& scope, Diagnostics& out);

/// The value of `when:` in behaviour `of`, whose conditions have been read.
///
/// Errors: E101 a name that is no condition of the behaviour; E104; E209; those of check_expression.
[[nodiscard]] When read_when(const Entry& entry, const Behaviour& of, const ConditionScope& scope,
                             Diagnostics& out);

}  // namespace tessera::spec
