#pragma once

#include <cmath>
#include <optional>
#include <ostream>
#include <string>

#include "tessera/recording.hpp"

namespace tessera::replay {

/// The events of a recording to show.
struct Selection {
  double from_s = 0, to_s = HUGE_VAL;
  std::size_t last = 0;    ///< only this many, the last ones; 0: all
  std::string subsystem;   ///< path, or "system"; empty: all
  std::string containing;  ///< only events whose text contains this
  bool events = true;      ///< firings, log lines, faults and the like
  /// Values of buffers whose path contains this; nullopt: none.
  std::optional<std::string> values;
};

/// Poses come 25 times a second and say nothing as text, so they are not listed as events.
[[nodiscard]] inline bool is_listed(const Recording::Entry& entry) {
  return entry.event.kind() != Event::Kind::poses;
}

/// A line per event, in the order of their times.
void print_events(const Recording& recording, const Selection& selection, std::ostream& to);

/// The same as CSV (RFC 4180): time_ns, sequence, kind, subsystem, version, text.
void write_csv(const Recording& recording, const Selection& selection, std::ostream& to);

/// Values as CSV, a row per change: time_ns, buffer, status (empty, "invalid", "no value", "failed"),
/// stamp_ns, then a column per field of the selected buffers, empty where a buffer has no such field. A value
/// that is one number stands in the column `value`. Only the first 16 elements of an array are shown.
void write_values_csv(const Recording& recording, const Selection& selection, std::ostream& to);

}  // namespace tessera::replay
