#pragma once

#include <vector>

#include "spec/document/families.hpp"
#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

/// Memory cells that are part of the net, and the changes to them.
namespace tessera::spec {

/// The values of a cell: `values: [nobody, a, b]`, `values: [nobody, each robot]` or `counts: 0..4`.
///
/// Precondition: the section has one of these keys.
/// Errors: E105, E106, E107 names of values; E262 no such list or range; E261 `initial` is none of them; E285, E290 `each`.
/// Returns values in any case, so that no second error follows from the first.
[[nodiscard]] FewValues read_few_values(const Section& cell, const FleetSizes* fleets, Diagnostics& out);

/// `sets: { lent_to: a, n: +1 }`. entry may be null.
///
/// Errors: E101 an unknown cell; E261 an unknown value; E265 a cell with a type; E266 no number of the counter,
///         or a step other than +1 and -1; E367 a cell with a goal; those of number_of for `sets: { lent_to: robot[i] }`.
/// member: for which it is; null: for none.
[[nodiscard]] std::vector<Change> read_changes(const Entry* entry, const std::vector<Field>& memory,
                                               const Member* member, Diagnostics& out);

/// Whether a counter may prevent the entry from being taken.
///
/// Errors: E267 it always does; E269 the entry changes cells with too many values together.
[[nodiscard]] bool check_entry(const Next& entry, const std::vector<Field>& memory, Diagnostics& out);

/// Warns of behaviours that may end with counts for which no entry of `next` holds. Warnings: W312.
void check_counters(const Subsystem& subsystem, Diagnostics& out);

/// Whether the behaviour that starts can begin.
///
/// Errors: E268 it takes a counter out of its range.
void check_start(const Subsystem& subsystem, Diagnostics& out);

}  // namespace tessera::spec
