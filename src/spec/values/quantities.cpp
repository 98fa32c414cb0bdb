#include "spec/values/quantities.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

struct Unit {
  std::string_view name;
  double factor;
};

constexpr std::array time_units = {Unit{"ns", 1},  Unit{"us", 1e3},   Unit{"\u00b5s", 1e3}, Unit{"ms", 1e6},
                                   Unit{"s", 1e9}, Unit{"min", 6e10}, Unit{"h", 3.6e12}};
constexpr std::array rate_units = {Unit{"Hz", 1}, Unit{"kHz", 1e3}};
constexpr std::array length_units = {Unit{"m", 1}, Unit{"cm", 1e-2}, Unit{"mm", 1e-3}, Unit{"", 1}};
constexpr std::array angle_units = {Unit{"deg", std::numbers::pi / 180}, Unit{"rad", 1}};

constexpr double longest_time_ns = 24 * 3.6e12;
constexpr double lowest_rate_hz = 0.001;
constexpr double highest_rate_hz = 100e3;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Reads a number with one of `units`. like: how to write it, e.g. "200 ms".
std::optional<double> read(const Node& node, Span at, std::string_view what, std::span<const Unit> units,
                           const std::string& like, Diagnostics& out) {
  const Node* text = text_of(node, at, what, out, "for example " + like);
  if (text == nullptr) return std::nullopt;
  const auto quantity = split_quantity(text->text);
  if (!quantity) {
    out.error("E205", text->span,
              std::string(what) + " must be a number with a unit, not " + in_quotes(text->text),
              "for example " + like);
    return std::nullopt;
  }
  for (const Unit& unit : units) {
    if (unit.name == quantity->unit) return quantity->number * unit.factor;
  }
  std::string known;
  for (const Unit& unit : units) {
    if (!unit.name.empty()) known += (known.empty() ? "" : ", ") + std::string(unit.name);
  }
  const bool bare = quantity->unit.empty();
  out.error("E205", text->span,
            bare ? std::string(what) + " needs a unit"
                 : "unknown unit " + in_quotes(quantity->unit) + " of " + std::string(what),
            "write one of " + known + "; for example " + like);
  return std::nullopt;
}

std::optional<double> in_range(std::optional<double> value, bool good, const Node& node,
                               const std::string& message, Diagnostics& out) {
  if (!value || good) return value;
  out.error("E206", node.span, message);
  return std::nullopt;
}

Duration nanoseconds(double value) { return Duration(static_cast<Duration::rep>(std::llround(value))); }

}  // namespace

std::optional<Quantity> split_quantity(std::string_view text) {
  text = trimmed(text);
  const bool plus = text.starts_with('+');
  const std::string_view digits = text.substr(plus ? 1 : 0);
  // from_chars also accepts "inf", "nan" and similar texts.
  const std::size_t first = digits.find_first_not_of("-.");
  if (first == std::string_view::npos || digits[first] < '0' || digits[first] > '9') return std::nullopt;
  Quantity result;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), result.number);
  if (error != std::errc() || !std::isfinite(result.number)) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - digits.data());
  result.digits = digits.substr(0, length);
  result.unit = trimmed(digits.substr(length));
  return result;
}

std::optional<Duration> read_duration(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  auto value = read(node, at, what, time_units, "200 ms", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value > 0, node, std::string(what) + " must be longer than zero", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value >= 1 && *value <= longest_time_ns, node,
                   std::string(what) + " must lie between 1 ns and 24 h", out);
  return value ? std::optional(nanoseconds(*value)) : std::nullopt;
}

std::optional<Duration> read_rate(const Node& node, Span at, Diagnostics& out) {
  auto value = read(node, at, "a rate", rate_units, "20 Hz", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value > 0, node, "a rate must be positive", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value >= lowest_rate_hz && *value <= highest_rate_hz, node,
                   "a rate must lie between 0.001 Hz and 100 kHz", out);
  return value ? std::optional(nanoseconds(1e9 / *value)) : std::nullopt;
}

std::optional<double> read_length(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  constexpr double longest_m = 1e6;
  const auto value = read(node, at, what, length_units, "8 mm", out);
  return in_range(value, value && std::abs(*value) <= longest_m, node,
                  std::string(what) + " is longer than 1000 km", out);
}

std::optional<double> read_angle(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  if (node.is_scalar()) {
    const auto quantity = split_quantity(node.text);
    if (quantity && quantity->number == 0 && quantity->unit.empty()) return 0.0;
  }
  return read(node, at, what, angle_units, "90 deg", out);
}

namespace {

struct Quantities {
  std::string_view base;
  double in_base;  ///< of the units' own factors
  std::span<const Unit> units;
};
constexpr std::array quantities = {Quantities{"m", 1, length_units}, Quantities{"rad", 1, angle_units},
                                   Quantities{"s", 1e-9, time_units}, Quantities{"Hz", 1, rate_units}};

}  // namespace

std::optional<double> si_factor(std::string_view unit) {
  if (const std::size_t slash = unit.find('/'); slash != std::string_view::npos) {
    const auto way = si_factor(unit.substr(0, slash)), time = si_factor(unit.substr(slash + 1));
    return way && time ? std::optional(*way / *time) : std::nullopt;
  }
  for (const Quantities& one : quantities)
    for (const Unit& known : one.units)
      if (!unit.empty() && known.name == unit) return known.factor * one.in_base;
  return std::nullopt;
}

namespace {

/// "m/s" for "cm/min"; empty: there is no such unit.
std::string si_unit(std::string_view unit) {
  if (const std::size_t slash = unit.find('/'); slash != std::string_view::npos) {
    const std::string way = si_unit(unit.substr(0, slash)), time = si_unit(unit.substr(slash + 1));
    return way.empty() || time.empty() ? "" : way + "/" + time;
  }
  for (const Quantities& one : quantities)
    for (const Unit& known : one.units)
      if (!unit.empty() && known.name == unit) return std::string(one.base);
  return "";
}

}  // namespace

std::optional<SiQuantity> in_si(const Quantity& quantity) {
  const auto factor = si_factor(quantity.unit);
  if (!factor) return std::nullopt;
  return SiQuantity{quantity.number * *factor, si_unit(quantity.unit)};
}

std::optional<BaseQuantity> read_any_quantity(const Node& node, Span at, std::string_view what,
                                              Diagnostics& out) {
  const Node* text = text_of(node, at, what, out, "write a number");
  const auto quantity = text == nullptr ? std::nullopt : split_quantity(text->text);
  if (!quantity) {
    if (text != nullptr)
      out.error("E205", text->span, std::string(what) + " must be a number, not " + in_quotes(text->text));
    return std::nullopt;
  }
  if (quantity->unit.empty()) return BaseQuantity{quantity->number, ""};
  std::string known;
  for (const Quantities& one : quantities)
    for (const Unit& unit : one.units) {
      if (unit.name == quantity->unit)
        return BaseQuantity{quantity->number * unit.factor * one.in_base, one.base};
      if (!unit.name.empty() && static_cast<unsigned char>(unit.name[0]) < 0x80)
        known += (known.empty() ? "" : ", ") + std::string(unit.name);
    }
  out.error("E205", text->span, "unknown unit " + in_quotes(quantity->unit) + " of " + std::string(what),
            "write one of " + known);
  return std::nullopt;
}

std::optional<double> read_number(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  const Node* text = text_of(node, at, what, out, "write a number");
  if (text == nullptr) return std::nullopt;
  const auto quantity = split_quantity(text->text);
  if (quantity && quantity->unit.empty() && !text->quoted) return quantity->number;
  out.error("E205", text->span, std::string(what) + " must be a number, not " + in_quotes(text->text));
  return std::nullopt;
}

}  // namespace tessera::spec
