#pragma once

#include <optional>

#include "spec/agents/defaults.hpp"
#include "spec/conditions/scope.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The options of one output in the map form of a behaviour's `send`: `{ when: CONDITION }` or `{ skip: allowed }`.
/// nullopt: it has none, or a mistake; then every iteration sends it.
///
/// option: its key is the name of the output, its value the options.
/// Errors: E324 no map with one of both; E325 both; E326 a condition that never holds; E327 another word than
///         `allowed`; those of read_condition.
/// Warnings: W385 a condition that always holds.
[[nodiscard]] std::optional<Skippable> read_skippable(const Entry& option, BufferId output,
                                                      const ConditionScope& scope, SharedConditions& shared,
                                                      Diagnostics& out);

}  // namespace tessera::spec
