#pragma once

#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads how a subsystem treats time and faults: overrun, overtime, receive, watchdog, recovery, non_finite, realtime.
///
/// Errors: E102 another key than `first` or `last`; E104 none of the choices; E110 `overrun` without a rate, `receive` without inputs; E204 a priority
///         outside 1 .. 99, a cpu outside 0 .. 1023, or one that is no number; E205, E206 durations.
void read_policies(const Section& section, Subsystem& subsystem, Diagnostics& out);

/// Errors: E110 `overtime` without a behaviour that has `takes`.
void check_overtime(const Section& section, const Subsystem& subsystem, Diagnostics& out);

/// The list of `send` or `receive` of a subsystem: [a, b], or that of { first: [a, b] } or { last: [a, b] }; or
/// nullptr. The entry has the position for complaints about the list.
[[nodiscard]] const Entry* list_of(const Entry& entry);

}  // namespace tessera::spec
