#include "ros2/parameters/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace tessera::ros2 {
namespace {

using ParameterKind = Ros2Parameter::Kind;

constexpr std::array<std::string_view, 10> type_names{
    "not set",        "bool",          "integer",       "double",       "string",
    "array of bytes", "array of bool", "integer array", "double array", "string array"};

template <class Value>
std::optional<Value> element_of(std::string_view text) {
  if constexpr (std::is_same_v<Value, bool>) {
    if (text == "true") return true;
    if (text == "false") return false;
    return std::nullopt;
  } else {
    Value value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
  }
}

template <class Value>
ParameterValue one_of(const std::string& text) {
  const auto value = element_of<Value>(text);
  return value ? ParameterValue(*value) : ParameterValue();
}

/// "[1, 2, 3]"
template <class Value>
ParameterValue all_of_array(std::string_view text) {
  std::vector<Value> values;
  if (!text.starts_with('[') || !text.ends_with(']')) return {};
  text = text.substr(1, text.size() - 2);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const auto value = element_of<Value>(text.substr(0, end));
    if (!value) return {};
    values.push_back(*value);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return values;
}

/// Whether some kind of parameter has values of this type.
template <class Value>
constexpr bool is_a_kind =
    !std::is_same_v<Value, std::monostate> && !std::is_same_v<Value, std::vector<std::byte>> &&
    !std::is_same_v<Value, std::vector<std::string>>;

std::string written(bool value) { return value ? "true" : "false"; }
std::string written(std::int64_t value) { return std::to_string(value); }
std::string written(double value) { return fmt::format("{}", value); }
std::string written(std::string value) { return value; }
template <class Value>
std::string written(const std::vector<Value>& values) {
  std::string text = "[";
  for (std::size_t index = 0; index < values.size(); ++index)
    text += (index == 0 ? "" : ", ") + written(static_cast<Value>(values[index]));
  return text + ']';
}

}  // namespace

ParameterValue value_of(const Ros2Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::boolean:
      return one_of<bool>(parameter.value);
    case ParameterKind::integer:
      return one_of<std::int64_t>(parameter.value);
    case ParameterKind::real:
      return one_of<double>(parameter.value);
    case ParameterKind::text:
      return parameter.value;
    case ParameterKind::booleans:
      return all_of_array<bool>(parameter.value);
    case ParameterKind::integers:
      return all_of_array<std::int64_t>(parameter.value);
    case ParameterKind::reals:
      return all_of_array<double>(parameter.value);
  }
  return {};
}

Result<std::string> text_for(const Ros2Parameter& parameter, const ParameterValue& value) {
  const auto wanted = static_cast<std::size_t>(parameter.kind);
  if (value.index() != wanted) {
    std::string text = fmt::format("parameter {} is of type {}, not {}", parameter.path, type_names[wanted],
                                   type_names[value.index()]);
    if (const auto* const whole = std::get_if<std::int64_t>(&value);
        whole != nullptr && parameter.kind == ParameterKind::real)
      text += fmt::format(": write {}.0", *whole);
    return Problem{std::move(text)};
  }
  return std::visit(
      []<class Value>(const Value& one) -> Result<std::string> {
        if constexpr (is_a_kind<Value>)
          return written(one);
        else
          return Problem{"a parameter cannot have that type"};  // no kind has its index
      },
      value);
}

}  // namespace tessera::ros2
