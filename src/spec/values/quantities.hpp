#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

/// Numbers with units as people write them: "200 ms", "20 Hz", "90 deg", "8 mm".
namespace tessera::spec {

/// A number and the text after it, trimmed.
struct Quantity {
  double number = 0;
  std::string_view digits;  ///< the number as written
  std::string_view unit;
};

/// nullopt if the text does not begin with a finite decimal number.
[[nodiscard]] std::optional<Quantity> split_quantity(std::string_view text);

/// at: position for a complaint about a missing value; what: the quantity in words, e.g. "timeout".
/// Errors: E205 no number or an unknown unit; E206 zero, negative or absurd.
[[nodiscard]] std::optional<Duration> read_duration(const Node& node, Span at, std::string_view what,
                                                    Diagnostics& out);
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
  std::string_view unit;
};
/// A number of any quantity, with or without a unit. Errors: E205 an unknown unit.
[[nodiscard]] std::optional<BaseQuantity> read_any_quantity(const Node& node, Span at, std::string_view what,
                                                            Diagnostics& out);
/// The value of a unit of a length, an angle, a time, a rate or a speed ("m/s") in m, rad, s, Hz or m/s.
/// nullopt: there is no such unit.
[[nodiscard]] std::optional<double> si_factor(std::string_view unit);
/// A quantity in the base unit of its kind: m, rad, s, Hz, m/s. nullopt: there is no such unit.
struct SiQuantity {
  double number = 0;
  std::string unit;
};
[[nodiscard]] std::optional<SiQuantity> in_si(const Quantity& quantity);
/// A number without a unit.
[[nodiscard]] std::optional<double> read_number(const Node& node, Span at, std::string_view what,
                                                Diagnostics& out);

}  // namespace tessera::spec
