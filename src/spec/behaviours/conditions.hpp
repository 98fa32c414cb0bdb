#pragma once

#include <optional>

#include "spec/behaviours/defaults.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// `conditions` of a subsystem. entry may be null: it has none.
///
/// Errors: E104-E106, those of check_expression.
[[nodiscard]] SharedConditions read_shared_conditions(const Entry* entry, const ConditionScope& scope,
                                                      Diagnostics& out);

/// A `terminal` or `error` condition. entry may be null: the condition never holds. A word alone, or a key of the map
/// without a value, names a condition of the subsystem.
///
/// Errors: E101 no condition of the subsystem; E104 neither bool nor text nor map; E105/E106/E107 names of
///         expressions; E209 no C++ expression; those of check_expression.
[[nodiscard]] Condition read_condition(const Entry* entry, const ConditionScope& scope,
                                       SharedConditions& shared, Diagnostics& out);

/// The value of `when:` in behaviour `of`, whose conditions have been read.
///
/// Errors: E101 a name that is no condition of the behaviour; E104; E209; those of check_expression.
[[nodiscard]] When read_when(const Entry& entry, const Behaviour& of, const ConditionScope& scope,
                             const SharedConditions& shared, Diagnostics& out);

}  // namespace tessera::spec
