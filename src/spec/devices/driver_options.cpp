#include "spec/devices/driver_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Units that may follow a number without a blank, beside those that can be converted. After a blank, every word
/// that begins with a letter may be a unit.
constexpr std::array close_units = std::to_array<std::string_view>({"V", "A", "%"});

/// 0x40, the usual form of addresses on a bus.
std::optional<double> hexadecimal(std::string_view text) {
  constexpr std::size_t most_digits = 13;  // as many as a double holds exactly
  if (!text.starts_with("0x") || text.size() > 2 + most_digits) return std::nullopt;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), number, 16);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return static_cast<double>(number);
}

/// A text that begins with a digit need not be a number with a unit: 192.168.0.1, "3rd floor", 8N1.
bool is_unit(const Quantity& quantity) {
  const std::string_view unit = quantity.unit;
  if (unit.empty() || simple_unit(unit) || std::ranges::find(close_units, unit) != close_units.end())
    return true;
  const bool apart = quantity.digits.data() + quantity.digits.size() != unit.data();
  const auto first = static_cast<unsigned char>(unit.front());
  const bool begins_well = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') || first >= 0x80;
  return apart && begins_well && unit.find(' ') == std::string_view::npos;
}

std::optional<DriverOption> world_value(const Node& node, const Entry& entry, Diagnostics& out) {
  if (!node.is_scalar() || node.text.empty()) {
    out.error(
        "E104", entry.span,
        "option " + in_quotes(entry.key) + " must be a number, a name, true or false, or a list of them",
        "for example { scan: laser, from: -135 deg, to: 135 deg, reach: 4 m }");
    return std::nullopt;
  }
  if (node.quoted) return DriverOption{node.text, ""};
  if (is_true(node) || is_false(node)) return DriverOption{is_true(node), ""};
  if (!split_quantity(node.text)) return DriverOption{node.text, ""};
  const auto quantity = read_any_quantity(node, entry.span, "option " + in_quotes(entry.key), out);
  if (!quantity) return std::nullopt;
  return DriverOption{quantity->number, std::string(quantity->unit)};
}

}  // namespace

std::optional<DriverOption> read_class_option(const Entry& entry, Diagnostics& out) {
  check_name(entry.key, entry.span, "option", out);
  const Node& node = *entry.value;
  if (!node.is_scalar()) {
    out.error("E104", entry.span,
              "option " + in_quotes(entry.key) + " must be a number, a text, true or false",
              "for example { cpp: Motor, pin: 4, device: /dev/ttyUSB0, inverted: true }");
    return std::nullopt;
  }
  if (node.quoted) return DriverOption{node.text, ""};
  if (is_true(node) || is_false(node)) return DriverOption{is_true(node), ""};
  if (const auto number = hexadecimal(node.text)) return DriverOption{*number, ""};
  if (const auto quantity = split_quantity(node.text); quantity && is_unit(*quantity))
    return DriverOption{quantity->number, std::string(quantity->unit)};
  return DriverOption{node.text, ""};
}

std::optional<DriverOption> read_world_option(const Entry& entry, Diagnostics& out) {
  check_name(entry.key, entry.span, "option", out);
  const Node& node = *entry.value;
  if (!node.is_sequence()) return world_value(node, entry, out);
  DriverOption option;
  option.is_list = true;
  for (const Node* item : node.items) {
    const auto value = world_value(*item, entry, out);
    if (!value) return std::nullopt;
    option.list.push_back(*value);
  }
  return option;
}

std::string with_agent_number(std::string text, std::uint32_t number) {
  constexpr std::string_view mark = "{i}";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at))
    text.replace(at, mark.size(), std::to_string(number));
  return text;
}

}  // namespace tessera::spec
