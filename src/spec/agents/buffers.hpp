#pragma once

#include <vector>

#include "spec/document/document.hpp"
#include "spec/document/families.hpp"
#include "spec/memory/goals.hpp"
#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

/// The data of a subsystem: buffers, memory, parameters.
namespace tessera::spec {

/// NAME: TYPE pairs. what: the kind of thing that is named, e.g. "input". entry may be null. "TYPE[each FLEET]" is one
/// buffer for each member.
///
/// fleets: null: there are none. Errors: besides those of names and types, E285, E290; E290 also for real buffers.
[[nodiscard]] std::vector<Field> read_buffers(const Entry* entry, std::string_view what, const Types& types,
                                              const FleetSizes* fleets, Diagnostics& out);

/// NAME: TYPE, NAME: { type, initial }, NAME: { values }, NAME: { counts } or NAME: { goal, progress } pairs. entry may
/// be null.
///
/// Errors: besides those of names and types, those of read_few_values and read_goal.
[[nodiscard]] std::vector<Field> read_memory(const Entry* entry, const GoalScope& buffers,
                                             const FleetSizes* fleets, Diagnostics& out);

/// NAME: VALUE or NAME: { type, default, min, max, unit } pairs. entry may be null.
///
/// Errors: besides those of names and types, E203 and E204 the default does not fit type or range.
[[nodiscard]] std::vector<Parameter> read_parameters(const Entry* entry, const Types& types,
                                                     Diagnostics& out);

/// Errors: E107 one name twice in the same scope (the inputs of a function, its outputs).
void check_distinct(const std::vector<const std::vector<Field>*>& scope, Diagnostics& out);

}  // namespace tessera::spec
