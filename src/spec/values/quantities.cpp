#include "spec/values/quantities.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// The units that people write for each quantity; tessera/units.hpp has their values.
constexpr auto time_units = std::to_array<std::string_view>({"ns", "us", "\u00b5s", "ms", "s", "min", "h"});
constexpr auto rate_units = std::to_array<std::string_view>({"Hz", "kHz"});
constexpr auto length_units = std::to_array<std::string_view>({"m", "cm", "mm"});
constexpr auto angle_units = std::to_array<std::string_view>({"deg", "rad"});

constexpr double longest_time_ns = 24 * 3.6e12;
constexpr double lowest_rate_hz = 0.001;
constexpr double highest_rate_hz = 100e3;

/// "ns, us, ms"
std::string listed(std::span<const std::string_view> units) {
  std::string known;
  for (const std::string_view unit : units) known += (known.empty() ? "" : ", ") + std::string(unit);
  return known;
}

/// Reads a number with one of `units`, in `in`. like: how to write it, e.g. "200 ms".
std::optional<double> read(const Node& node, Span at, std::string_view what,
                           std::span<const std::string_view> units, std::string_view in,
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
  if (std::ranges::find(units, quantity->unit) != units.end())
    return converted(quantity->number, quantity->unit, in);
  const bool bare = quantity->unit.empty();
  out.error("E205", text->span,
            bare ? std::string(what) + " needs a unit"
                 : "unknown unit " + in_quotes(quantity->unit) + " of " + std::string(what),
            "write one of " + listed(units) + "; for example " + like);
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

std::optional<Duration> read_moment(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  auto value = read(node, at, what, time_units, "ns", "3 s", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value >= 0 && *value <= longest_time_ns, node,
                   std::string(what) + " must lie between 0 s and 24 h", out);
  return value ? std::optional(nanoseconds(*value)) : std::nullopt;
}

std::optional<Duration> read_duration(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  auto value = read(node, at, what, time_units, "ns", "200 ms", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value > 0, node, std::string(what) + " must be longer than zero", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value >= 1 && *value <= longest_time_ns, node,
                   std::string(what) + " must lie between 1 ns and 24 h", out);
  return value ? std::optional(nanoseconds(*value)) : std::nullopt;
}

std::optional<Takes> read_time_range(const Node& node, Span at, Diagnostics& out) {
  constexpr std::string_view what = "takes", between = "..";
  const std::size_t dots = node.is_scalar() ? node.text.find(between) : std::string::npos;
  if (dots == std::string::npos) {
    const std::optional<Duration> both = read_duration(node, at, what, out);
    return both ? std::optional(Takes{*both, *both}) : std::nullopt;
  }
  Node longest = node, shortest = node;
  longest.text = node.text.substr(dots + between.size());
  shortest.text = node.text.substr(0, dots);
  const auto last = split_quantity(longest.text), first = split_quantity(shortest.text);
  if (!last || !first) {
    out.error("E205", node.span, "takes must be a time or a range of times, not " + in_quotes(node.text),
              "for example 1..3 ms");
    return std::nullopt;
  }
  // "1..3 ms": the unit belongs to both.
  if (first->unit.empty()) shortest.text += last->unit;
  const std::optional<Duration> most = read_duration(longest, at, what, out);
  const std::optional<Duration> least = most ? read_moment(shortest, at, what, out) : std::nullopt;
  if (!least) return std::nullopt;
  if (*least <= *most) return Takes{*least, *most};
  out.error("E206", node.span,
            "the shortest time stands before the longest one, but " + in_quotes(node.text) +
                " begins with the longer one");
  return std::nullopt;
}

std::optional<Duration> read_rate(const Node& node, Span at, Diagnostics& out) {
  auto value = read(node, at, "a rate", rate_units, "Hz", "20 Hz", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value > 0, node, "a rate must be positive", out);
  if (!value) return std::nullopt;
  value = in_range(value, *value >= lowest_rate_hz && *value <= highest_rate_hz, node,
                   "a rate must lie between 0.001 Hz and 100 kHz", out);
  return value ? std::optional(nanoseconds(1e9 / *value)) : std::nullopt;
}

std::optional<double> read_length(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  constexpr double longest_m = 1e6;
  const auto bare = node.is_scalar() ? split_quantity(node.text) : std::nullopt;
  const auto value = bare && bare->unit.empty() ? std::optional(bare->number)
                                                : read(node, at, what, length_units, "m", "8 mm", out);
  return in_range(value, value && std::abs(*value) <= longest_m, node,
                  std::string(what) + " is longer than 1000 km", out);
}

std::optional<double> read_angle(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  if (node.is_scalar()) {
    const auto quantity = split_quantity(node.text);
    if (quantity && quantity->number == 0 && quantity->unit.empty()) return 0.0;
  }
  return read(node, at, what, angle_units, "rad", "90 deg", out);
}

std::optional<SiQuantity> in_si(const Quantity& quantity) {
  const std::optional<Unit> unit = read_unit(quantity.unit);
  if (!unit) return std::nullopt;
  return SiQuantity{quantity.number * unit->above / unit->below, si_name(*unit)};
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
  if (const std::optional<Unit> unit = simple_unit(quantity->unit))
    return BaseQuantity{quantity->number * unit->above / unit->below, si_name(*unit)};
  constexpr std::array<std::span<const std::string_view>, 4> quantities{length_units, angle_units, time_units,
                                                                        rate_units};
  std::string known;
  for (const auto units : quantities) known += (known.empty() ? "" : ", ") + listed(units);
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
