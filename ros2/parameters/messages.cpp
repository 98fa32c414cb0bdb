#include "ros2/parameters/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

#include "ros2/codec/cdr_message.hpp"

namespace tessera::ros2 {
namespace {

using OfferedType = Ros2Parameter::Kind;

constexpr std::size_t most_padding_of_parameters = 3;

/// A sequence, a text or a number of a message. The count of a sequence is not trusted: each element has a byte.
template <class Value>
struct Reading {
  static Value from(CdrReader& reader) {
    const auto bytes = reader.numbers(sizeof(Value), 1);
    std::array<std::byte, sizeof(Value)> own{};
    if (!bytes.empty()) std::ranges::copy(bytes, own.begin());
    if (reader.swapped()) std::ranges::reverse(own);
    return std::bit_cast<Value>(own);
  }
};
template <>
struct Reading<bool> {
  static bool from(CdrReader& reader) {
    const auto byte = Reading<std::uint8_t>::from(reader);
    if (byte > 1) reader.fail();
    return byte == 1;
  }
};
template <>
struct Reading<std::string> {
  static std::string from(CdrReader& reader) { return std::string(reader.text()); }
};
template <class Value>
struct Reading<std::vector<Value>> {
  static std::vector<Value> from(CdrReader& reader) {
    std::vector<Value> all;
    const std::size_t count = reader.length();
    if (count > reader.left()) reader.fail();
    for (std::size_t index = 0; index < count && reader.ok(); ++index)
      all.push_back(Reading<Value>::from(reader));
    return all;
  }
};
template <>
struct Reading<ParameterValue> {
  /// All fields are there; the type says which one counts.
  static ParameterValue from(CdrReader& reader) {
    const auto type = Reading<std::uint8_t>::from(reader);
    ParameterValue value;
    if (type >= std::variant_size_v<ParameterValue>) reader.fail();
    [&]<std::size_t... Index>(std::index_sequence<Index...>) {
      (read_field<Index + 1>(reader, type, value), ...);
    }
    (std::make_index_sequence<std::variant_size_v<ParameterValue> - 1>());
    return value;
  }

 private:
  template <std::size_t Index>
  static void read_field(CdrReader& reader, std::size_t type, ParameterValue& value) {
    auto field = Reading<std::variant_alternative_t<Index, ParameterValue>>::from(reader);
    if (type == Index) value.emplace<Index>(std::move(field));
  }
};
template <>
struct Reading<NamedValue> {
  static NamedValue from(CdrReader& reader) {
    std::string name = Reading<std::string>::from(reader);
    return {std::move(name), Reading<ParameterValue>::from(reader)};
  }
};

template <class Value>
std::optional<Value> whole(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  Value value = Reading<Value>::from(*reader);
  if (!reader->ok() || reader->left() > most_padding_of_parameters) return std::nullopt;
  return value;
}

void put(const ParameterValue& value, CdrWriter& writer);
void put(const NamedValue& named, CdrWriter& writer);
void put(const SetOutcome& outcome, CdrWriter& writer);
void put(const Described& described, CdrWriter& writer);
void put(const std::pair<std::string, std::string>& pair, CdrWriter& writer);
template <class Number>
requires std::is_arithmetic_v<Number> || std::is_same_v<Number, std::byte>
void put(Number number, CdrWriter& writer) { writer.number(&number, sizeof number); }
void put(const std::string& text, CdrWriter& writer) { writer.text(text); }
template <class Element>
void put_all(const Element& elements, CdrWriter& writer) {
  writer.length(static_cast<std::uint32_t>(elements.size()));
  for (const auto& one : elements) put(one, writer);
}
template <class Value>
void put(const std::vector<Value>& values, CdrWriter& writer) {
  writer.length(static_cast<std::uint32_t>(values.size()));
  for (const auto& one : values) put(static_cast<const Value&>(one), writer);
}

template <std::size_t Index>
void put_field(const ParameterValue& value, CdrWriter& writer) {
  using Field = std::variant_alternative_t<Index, ParameterValue>;
  const Field* const given = std::get_if<Index>(&value);
  put(given == nullptr ? Field{} : *given, writer);
}
void put(const ParameterValue& value, CdrWriter& writer) {
  put(static_cast<std::uint8_t>(value.index()), writer);
  [&]<std::size_t... Index>(std::index_sequence<Index...>) { (put_field<Index + 1>(value, writer), ...); }
  (std::make_index_sequence<std::variant_size_v<ParameterValue> - 1>());
}
void put(const NamedValue& named, CdrWriter& writer) {
  put(named.first, writer);
  put(named.second, writer);
}
/// SetParametersResult.
void put(const SetOutcome& outcome, CdrWriter& writer) {
  put(!outcome.has_value(), writer);
  put(outcome.value_or(std::string()), writer);
}
void put(const Stamp& stamp, CdrWriter& writer) {
  put(stamp.sec, writer);
  put(stamp.nanosec, writer);
}

/// The nearest whole number of 64 bits.
std::int64_t whole_number(double number) {
  constexpr double beyond = 9223372036854775808.0;
  if (number >= beyond) return std::numeric_limits<std::int64_t>::max();
  if (number <= -beyond) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(number);
}

/// Clients check ranges of single numbers only, so those of elements are words.
std::string constraints_of(const Ros2Parameter& parameter) {
  if (parameter.kind == OfferedType::text) return fmt::format("at most {} bytes", parameter.longest);
  if (parameter.elements == 0) return "";
  std::string text = fmt::format("{} elements", parameter.elements);
  if (std::isfinite(parameter.minimum)) text += fmt::format(", each at least {}", parameter.minimum);
  if (std::isfinite(parameter.maximum)) text += fmt::format(", each at most {}", parameter.maximum);
  return text;
}

void put_ranges(const Ros2Parameter& parameter, CdrWriter& writer) {
  const bool limited = std::isfinite(parameter.minimum) || std::isfinite(parameter.maximum);
  const bool real = limited && parameter.kind == OfferedType::real;
  const bool integer = limited && parameter.kind == OfferedType::integer;
  constexpr double most = std::numeric_limits<double>::max();
  writer.length(real ? 1 : 0);
  if (real) {
    put(std::max(parameter.minimum, -most), writer);
    put(std::min(parameter.maximum, most), writer);
    put(0.0, writer);
  }
  writer.length(integer ? 1 : 0);
  if (integer) {
    put(whole_number(std::ceil(parameter.minimum)), writer);
    put(whole_number(std::floor(parameter.maximum)), writer);
    put(std::uint64_t{1}, writer);
  }
}

/// ParameterDescriptor.
void put(const Described& described, CdrWriter& writer) {
  const Ros2Parameter none{};
  const Ros2Parameter* const parameter = described.second;
  const Ros2Parameter& shown = parameter == nullptr ? none : *parameter;
  put(described.first, writer);
  put(parameter == nullptr ? std::uint8_t{0} : static_cast<std::uint8_t>(shown.kind), writer);
  put(shown.unit.empty() ? std::string() : "in " + shown.unit, writer);
  put(parameter == nullptr ? std::string() : constraints_of(shown), writer);
  put(false, writer);  // read_only
  put(false, writer);  // dynamic_typing
  put_ranges(shown, writer);
}

void put(const std::pair<std::string, std::string>& pair, CdrWriter& writer) {
  put(pair.first, writer);
  put(pair.second, writer);
}

}  // namespace

std::optional<std::vector<std::string>> read_names(std::span<const std::byte> message) {
  return whole<std::vector<std::string>>(message);
}

std::optional<ListRequest> read_list_request(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  ListRequest request;
  request.prefixes = Reading<std::vector<std::string>>::from(*reader);
  request.depth = Reading<std::uint64_t>::from(*reader);
  if (!reader->ok() || reader->left() > most_padding_of_parameters) return std::nullopt;
  return request;
}

std::optional<std::vector<NamedValue>> read_set_request(std::span<const std::byte> message) {
  return whole<std::vector<NamedValue>>(message);
}

std::vector<std::byte> list_answer(std::span<const std::string> names,
                                   std::span<const std::string> prefixes) {
  return cdr_message([&](CdrWriter& writer) {
    put_all(names, writer);
    put_all(prefixes, writer);
  });
}

std::vector<std::byte> values_answer(std::span<const ParameterValue> values) {
  return cdr_message([&](CdrWriter& writer) { put_all(values, writer); });
}

std::vector<std::byte> types_answer(std::span<const ParameterValue> values) {
  return cdr_message([&](CdrWriter& writer) {
    writer.length(static_cast<std::uint32_t>(values.size()));
    for (const ParameterValue& one : values) put(static_cast<std::uint8_t>(one.index()), writer);
  });
}

std::vector<std::byte> descriptors_answer(std::span<const Described> parameters) {
  return cdr_message([&](CdrWriter& writer) { put_all(parameters, writer); });
}

std::vector<std::byte> set_answer(std::span<const SetOutcome> outcomes) {
  return cdr_message([&](CdrWriter& writer) { put_all(outcomes, writer); });
}

std::vector<std::byte> set_all_answer(const SetOutcome& outcome) {
  return cdr_message([&](CdrWriter& writer) { put(outcome, writer); });
}

std::vector<std::byte> event_message(const ParameterEvent& event) {
  return cdr_message([&](CdrWriter& writer) {
    put(event.stamp, writer);
    put(event.node, writer);
    put(event.made, writer);
    put(event.changed, writer);
    writer.length(0);  // none is deleted
  });
}

std::vector<std::byte> diagnostics_message(const Stamp& stamp, const std::string& node,
                                           const std::string& hardware,
                                           std::span<const Ros2Status> statuses) {
  return cdr_message([&](CdrWriter& writer) {
    put(stamp, writer);
    put(std::string(), writer);  // frame_id
    writer.length(static_cast<std::uint32_t>(statuses.size()));
    for (const Ros2Status& one : statuses) {
      put(static_cast<std::uint8_t>(one.level), writer);
      put(node + ": " + one.path, writer);
      put(one.message, writer);
      put(hardware, writer);
      put_all(one.values, writer);
    }
  });
}

}  // namespace tessera::ros2
