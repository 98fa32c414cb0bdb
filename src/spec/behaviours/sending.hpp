#pragma once

#include <vector>

#include "spec/behaviours/defaults.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The options of outputs in the map form of a behaviour's `send`: `{ when: CONDITION }` or `{ skip: allowed }`. After a
/// mistake every iteration sends the output.
///
/// Errors: E324 no map with one of both; E325 both; E326 a condition that never holds; E327 another word than
///         `allowed`; E330 a type with a field `skip`; those of read_condition.
/// Warnings: W385 a condition that always holds.
[[nodiscard]] std::vector<Skippable> read_skippable(const std::vector<ListedOption>& options,
                                                    const ConditionScope& scope, SharedConditions& shared,
                                                    Diagnostics& out);

}  // namespace tessera::spec
