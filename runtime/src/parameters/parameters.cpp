#include "parameters/parameters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "tessera/nearest.hpp"
#include "tessera/units.hpp"

namespace tessera {
namespace {

using Parameter = Bindings::Parameter;

/// Whether a pattern such as "robot[*].control" matches "robot[3].control".
[[nodiscard]] bool matches(std::string_view pattern, std::string_view path) {
  constexpr std::string_view any = "[*]";
  while (true) {
    const std::size_t star = pattern.find(any);
    if (star == std::string_view::npos) return pattern == path;
    if (path.substr(0, star) != pattern.substr(0, star)) return false;
    pattern.remove_prefix(star + any.size());
    path.remove_prefix(star);
    if (!path.starts_with('[') || path.find(']') == std::string_view::npos) return false;
    path.remove_prefix(path.find(']') + 1);
  }
}

/// Whether a pattern names that subsystem, or its agent: "robot[1]".
[[nodiscard]] bool is_owner(std::string_view pattern, std::string_view path) {
  return matches(pattern, path) || matches(pattern, path.substr(0, path.rfind('.')));
}

/// All names that a parameter has on the command line.
[[nodiscard]] std::vector<std::string> names_of(std::span<const ParameterOwner> owners) {
  std::vector<std::string> names;
  for (const ParameterOwner& owner : owners)
    for (const Parameter& parameter : owner.parameters) {
      names.emplace_back(parameter.name);
      names.push_back(fmt::format("{}.{}", owner.path, parameter.name));
    }
  return names;
}

/// The number of a text in the parameter's unit: "5 cm" for a parameter in m is "0.05". A text without a unit
/// stays as it is, also if it is no number.
[[nodiscard]] Result<std::string> in_its_unit(const Parameter& parameter, std::string_view text) {
  const std::optional<Quantity> given = split_quantity(text);
  if (!given || given->unit.empty()) return std::string(text);
  if (given->unit == parameter.unit) return std::string(given->digits);
  if (const std::optional<double> number = converted(given->number, given->unit, parameter.unit);
      number && !parameter.unit.empty())
    return fmt::format("{}", *number);
  if (!parameter.unit.empty())
    return Problem{
        fmt::format("has another unit: the parameter is in {0}; write a number in {0}", parameter.unit)};
  const std::optional<Unit> unit = read_unit(given->unit);
  const std::string si = unit ? si_name(*unit) : "";
  const std::string number =
      unit ? fmt::format("{}", given->number * unit->above / unit->below) : std::string(given->digits);
  return Problem{fmt::format("has a unit, and the parameter has none; write the number alone: {}{}", number,
                             !si.empty() && si != given->unit ? " if it is in " + si : "")};
}

// Each `store` returns the mistake in the text.

template <class Number>
[[nodiscard]] std::optional<Problem> store_bare_number(const Parameter& parameter, std::string_view text);

template <class Number>
[[nodiscard]] std::optional<Problem> store_number(const Parameter& parameter, std::string_view text) {
  const Result<std::string> number = in_its_unit(parameter, text);
  if (!number) return Problem{number.problem()};
  return store_bare_number<Number>(parameter, *number);
}

template <class Number>
[[nodiscard]] std::optional<Problem> store_bare_number(const Parameter& parameter, std::string_view text) {
  Number value{};
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem == std::errc::result_out_of_range) return Problem{"does not fit its type"};
  if (problem != std::errc{} || end != text.data() + text.size())
    return Problem{std::is_integral_v<Number> ? "is no whole number" : "is no number"};
  const auto real = static_cast<double>(value);
  if (!std::isfinite(real)) return Problem{"is not finite"};
  if (real < parameter.minimum || real > parameter.maximum)
    return Problem{fmt::format("is out of range {} to {}", parameter.minimum, parameter.maximum)};
  std::memcpy(parameter.value, &value, sizeof value);
  return std::nullopt;
}

[[nodiscard]] std::optional<Problem> store_bool(const Parameter& parameter, std::string_view text) {
  const bool value = text == "true" || text == "1";
  if (!value && text != "false" && text != "0") return Problem{"is neither true nor false"};
  std::memcpy(parameter.value, &value, sizeof value);
  return std::nullopt;
}

[[nodiscard]] std::optional<Problem> store_string(const Parameter& parameter, std::string_view text) {
  if (text.size() > parameter.capacity)
    return Problem{fmt::format("is longer than {} bytes", parameter.capacity)};
  // The layout of BoundedString: its size, then its bytes.
  const auto size = static_cast<std::uint32_t>(text.size());
  auto* bytes = static_cast<std::byte*>(parameter.value);
  std::memset(bytes, 0, parameter.size);
  std::memcpy(bytes, &size, sizeof size);
  std::memcpy(bytes + sizeof size, text.data(), text.size());
  return std::nullopt;
}

[[nodiscard]] std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

[[nodiscard]] std::optional<Problem> store_array(const Parameter& parameter, std::string_view text);

[[nodiscard]] std::optional<Problem> store(const Parameter& parameter, std::string_view text) {
  if (parameter.elements > 0) return store_array(parameter, text);
  if (parameter.capacity > 0) return store_string(parameter, text);
  if (!parameter.scalar) return Problem{"cannot be given: the parameter is a structure"};
  switch (*parameter.scalar) {
    case Scalar::boolean:
      return store_bool(parameter, text);
    case Scalar::int8:
      return store_number<std::int8_t>(parameter, text);
    case Scalar::int16:
      return store_number<std::int16_t>(parameter, text);
    case Scalar::int32:
      return store_number<std::int32_t>(parameter, text);
    case Scalar::int64:
      return store_number<std::int64_t>(parameter, text);
    case Scalar::uint8:
      return store_number<std::uint8_t>(parameter, text);
    case Scalar::uint16:
      return store_number<std::uint16_t>(parameter, text);
    case Scalar::uint32:
      return store_number<std::uint32_t>(parameter, text);
    case Scalar::uint64:
      return store_number<std::uint64_t>(parameter, text);
    case Scalar::float32:
      return store_number<float>(parameter, text);
    case Scalar::float64:
      return store_number<double>(parameter, text);
  }
  return std::nullopt;
}

/// "[1, 2, 3]"; the brackets may be left out.
[[nodiscard]] std::optional<Problem> store_array(const Parameter& parameter, std::string_view text) {
  const std::string whole = trimmed(text);
  std::string_view rest = whole;
  if (rest.starts_with('[') && rest.ends_with(']')) rest = rest.substr(1, rest.size() - 2);
  std::vector<std::string> parts;
  for (std::size_t end = 0; end != std::string_view::npos && !trimmed(rest).empty();) {
    end = rest.find(',');
    parts.push_back(trimmed(rest.substr(0, end)));
    if (end != std::string_view::npos) rest.remove_prefix(end + 1);
  }
  if (parts.size() != parameter.elements)
    return Problem{fmt::format("has {} element{}, and the parameter has {}: write [1, 2, 3]", parts.size(),
                               parts.size() == 1 ? "" : "s", parameter.elements)};
  Parameter element = parameter;
  element.elements = 0;
  element.size = parameter.size / parameter.elements;
  for (std::size_t at = 0; at < parts.size(); ++at) {
    element.value = static_cast<std::byte*>(parameter.value) + at * element.size;
    if (const std::optional<Problem> wrong = store(element, parts[at]))
      return Problem{fmt::format("is wrong: element {} ({}) {}", at, parts[at], wrong->text)};
  }
  return std::nullopt;
}

template <class Number>
[[nodiscard]] std::string given_number(const void* at) {
  Number number{};
  std::memcpy(&number, at, sizeof number);
  return fmt::format("{}", number);
}

[[nodiscard]] std::string given_string(const void* at) {
  std::uint32_t size = 0;  // as store_string has written it
  std::memcpy(&size, at, sizeof size);
  return {static_cast<const char*>(at) + sizeof size, size};
}

}  // namespace

std::string text_of(const Bindings::Parameter& parameter, const void* at) {
  if (parameter.elements > 0) {
    Parameter element = parameter;
    element.elements = 0;
    element.size = parameter.size / parameter.elements;
    std::string all;
    for (std::size_t index = 0; index < parameter.elements; ++index)
      all += (index == 0 ? "" : ", ") +
             text_of(element, static_cast<const std::byte*>(at) + index * element.size);
    return '[' + all + ']';
  }
  if (parameter.capacity > 0) return given_string(at);
  if (!parameter.scalar) return "?";
  switch (*parameter.scalar) {
    case Scalar::boolean:
      return given_number<bool>(at);
    case Scalar::int8:
      return given_number<std::int8_t>(at);
    case Scalar::int16:
      return given_number<std::int16_t>(at);
    case Scalar::int32:
      return given_number<std::int32_t>(at);
    case Scalar::int64:
      return given_number<std::int64_t>(at);
    case Scalar::uint8:
      return given_number<std::uint8_t>(at);
    case Scalar::uint16:
      return given_number<std::uint16_t>(at);
    case Scalar::uint32:
      return given_number<std::uint32_t>(at);
    case Scalar::uint64:
      return given_number<std::uint64_t>(at);
    case Scalar::float32:
      return given_number<float>(at);
    case Scalar::float64:
      return given_number<double>(at);
  }
  return "?";
}

bool has_parameter(std::span<const ParameterOwner> owners, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view name = dot == std::string::npos ? path : std::string_view(path).substr(dot + 1);
  return std::ranges::any_of(owners, [&](const ParameterOwner& owner) {
    return (dot == std::string::npos || matches(std::string_view(path).substr(0, dot), owner.path)) &&
           std::ranges::any_of(owner.parameters,
                               [&](const Parameter& parameter) { return parameter.name == name; });
  });
}

std::optional<Problem> check_parameter(std::span<const ParameterOwner> owners, const std::string& path,
                                       const std::string& value, std::vector<CheckedValue>& checked) {
  const std::size_t dot = path.rfind('.');
  const std::string_view name =
      dot == std::string::npos ? std::string_view(path) : std::string_view(path).substr(dot + 1);
  std::vector<CheckedValue> found;
  for (std::uint32_t index = 0; index < owners.size(); ++index) {
    const ParameterOwner& owner = owners[index];
    if (dot != std::string::npos && !is_owner(std::string_view(path).substr(0, dot), owner.path)) continue;
    for (const Parameter& parameter : owner.parameters) {
      if (parameter.name != name) continue;
      CheckedValue one{index, parameter, std::vector<std::byte>(parameter.size)};
      Parameter scratch = parameter;
      scratch.value = one.bytes.data();
      if (const std::optional<Problem> wrong = store(scratch, value))
        return Problem{fmt::format("parameter {} = {}: {} {}", path, value, value.empty() ? "nothing" : value,
                                   wrong->text)};
      found.push_back(std::move(one));
    }
  }
  if (found.empty())
    return Problem{with_hint("unknown parameter '" + path + "'", did_you_mean(path, names_of(owners)))};
  std::ranges::move(found, std::back_inserter(checked));
  return std::nullopt;
}

bool set_parameters(std::span<const ParameterOwner> owners,
                    std::span<const std::pair<std::string, std::string>> values, std::string& error) {
  error.clear();
  std::vector<CheckedValue> checked;
  for (const auto& [path, value] : values)
    if (const std::optional<Problem> wrong = check_parameter(owners, path, value, checked))
      error += (error.empty() ? "" : "\n") + wrong->text;
  for (const CheckedValue& one : checked) one.give();
  return error.empty();
}

bool read_parameter_file(const std::string& file, std::vector<std::pair<std::string, std::string>>& values,
                         std::string& error) {
  std::ifstream stream(file);
  if (!stream) {
    error = fmt::format("cannot read the parameters in '{}'", file);
    return false;
  }
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string text = trimmed(std::string_view(line).substr(0, line.find('#')));
    if (text.empty()) continue;
    const std::size_t equals = text.find('=');
    const std::string path = trimmed(std::string_view(text).substr(0, equals));
    if (equals == std::string::npos || path.empty()) {
      error = fmt::format("{}:{}: expected 'path = value'", file, number);
      return false;
    }
    values.emplace_back(path, trimmed(std::string_view(text).substr(equals + 1)));
  }
  return true;
}

}  // namespace tessera
