#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"
#include "tessera/units.hpp"

/// Numbers with units as people write them: "200 ms", "20 Hz", "90 deg", "8 mm".
namespace tessera::spec {

/// at: position for a complaint about a missing value; what: the quantity in words, e.g. "timeout".
/// Errors: E205 no number or an unknown unit; E206 zero, negative or absurd.
[[nodiscard]] std::optional<Duration> read_duration(const Node& node, Span at, std::string_view what,
                                                    Diagnostics& out);
/// A time from the start of a run: as a duration, but also 0 s.
[[nodiscard]] std::optional<Duration> read_moment(const Node& node, Span at, std::string_view what,
                                                  Diagnostics& out);
/// "2 ms", or from the shortest to the longest time: "1..3 ms", "500 us..3 ms", "0..3 ms".
/// Errors: as read_duration; E206 the first time is longer than the second one.
[[nodiscard]] std::optional<Takes> read_time_range(const Node& node, Span at, Diagnostics& out);
/// The period of a rate in Hz or kHz.
[[nodiscard]] std::optional<Duration> read_rate(const Node& node, Span at, Diagnostics& out);
/// Metres; a number without a unit counts as metres.
[[nodiscard]] std::optional<double> read_length(const Node& node, Span at, std::string_view what,
                                                Diagnostics& out);
/// Radians; only 0 may have no unit.
[[nodiscard]] std::optional<double> read_angle(const Node& node, Span at, std::string_view what,
                                               Diagnostics& out);
/// A number in the base unit of its quantity: m, rad, s or Hz; empty: the number has no unit.
struct BaseQuantity {
  double number = 0;
  std::string unit;
};
/// A number of any quantity, with or without a unit. Errors: E205 an unknown unit.
[[nodiscard]] std::optional<BaseQuantity> read_any_quantity(const Node& node, Span at, std::string_view what,
                                                            Diagnostics& out);
/// A quantity in the SI unit of its kind: m, rad, s, Hz, m/s, m/s^2. nullopt: its unit is not known.
struct SiQuantity {
  double number = 0;
  std::string unit;
};
[[nodiscard]] std::optional<SiQuantity> in_si(const Quantity& quantity);
/// A number without a unit.
[[nodiscard]] std::optional<double> read_number(const Node& node, Span at, std::string_view what,
                                                Diagnostics& out);

}  // namespace tessera::spec
