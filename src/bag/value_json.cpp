#include "bag/value_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tessera/value_layout.hpp"

namespace tessera::bag {

using nlohmann::ordered_json;
using Node = ValueLayout::Node;

namespace {

/// Writes one value.
class ValueWriter {
 public:
  explicit ValueWriter(std::string_view bytes) : rest_(bytes) {}

  void write(const Node& type) {
    switch (type.kind) {
      case Node::Kind::structure:
        return write_structure(type);
      case Node::Kind::sequence:
        return write_sequence(type);
      case Node::Kind::text:
        text_ += json_text(take(length(type.size)));
        return;
      case Node::Kind::bytes: {
        text_ += '"';
        for (const char byte : take(type.size))
          fmt::format_to(std::back_inserter(text_), "{:02x}", static_cast<std::uint8_t>(byte));
        text_ += '"';
        return;
      }
      default:
        write_scalar(type);
    }
  }
  [[nodiscard]] std::optional<std::string> result() && {
    if (!ok_ || !rest_.empty()) return std::nullopt;
    return std::move(text_);
  }

 private:
  std::string_view take(std::size_t count) {
    ok_ = ok_ && count <= rest_.size();
    if (!ok_) return {};
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  template <class Number>
  Number number() {
    Number value{};
    if (const std::string_view bytes = take(sizeof value); ok_)
      std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  std::size_t length(std::size_t most) {
    const std::size_t length = number<std::uint32_t>();
    ok_ = ok_ && length <= most;
    return ok_ ? length : 0;
  }

  void write_structure(const Node& type) {
    text_ += '{';
    for (const Node::Field& field : type.fields) {
      if (&field != type.fields.data()) text_ += ',';
      text_ += json_text(field.name) + ':';
      write(*field.type);
    }
    text_ += '}';
  }

  void write_sequence(const Node& type) {
    const std::size_t count = type.bounded ? length(type.size) : type.size;
    text_ += '[';
    for (std::size_t index = 0; index < count && ok_; ++index) {
      if (index > 0) text_ += ',';
      write(*type.element);
    }
    text_ += ']';
  }

  template <class Number>
  void write_number() {
    const Number value = number<Number>();
    if constexpr (std::is_floating_point_v<Number>)
      if (!std::isfinite(value)) {
        text_ += "null";
        return;
      }
    fmt::format_to(std::back_inserter(text_), "{}", value);
  }

  template <class One, class Two, class Four, class Eight>
  void write_integer(std::size_t size) {
    if (size == 1)
      fmt::format_to(std::back_inserter(text_), "{}", static_cast<int>(number<One>()));
    else if (size == 2)
      write_number<Two>();
    else if (size == 4)
      write_number<Four>();
    else
      write_number<Eight>();
  }

  void write_scalar(const Node& type) {
    if (type.kind == Node::Kind::boolean)
      text_ += number<std::uint8_t>() != 0 ? "true" : "false";
    else if (type.kind == Node::Kind::integer)
      write_integer<std::int8_t, std::int16_t, std::int32_t, std::int64_t>(type.size);
    else if (type.kind == Node::Kind::natural)
      write_integer<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>(type.size);
    else if (type.size == sizeof(float))
      write_number<float>();
    else
      write_number<double>();
  }

  std::string_view rest_;
  std::string text_;
  bool ok_ = true;
};

ordered_json schema_of(const Node& type, const std::string& path,
                       const std::map<std::string, std::string>& units) {
  ordered_json schema;
  switch (type.kind) {
    case Node::Kind::structure: {
      schema["type"] = "object";
      ordered_json properties = ordered_json::object();
      for (const Node::Field& field : type.fields)
        properties[field.name] =
            schema_of(*field.type, path.empty() ? field.name : path + "." + field.name, units);
      schema["properties"] = std::move(properties);
      return schema;
    }
    case Node::Kind::sequence:
      schema["type"] = "array";
      schema["items"] = schema_of(*type.element, path, units);
      return schema;
    case Node::Kind::text:
    case Node::Kind::bytes:
      schema["type"] = "string";
      break;
    case Node::Kind::boolean:
      schema["type"] = "boolean";
      break;
    case Node::Kind::real:
      schema["type"] = "number";
      // A list of types would make viewers refuse the whole topic.
      schema["nullable"] = true;
      break;
    default:
      schema["type"] = "integer";
  }
  if (const auto unit = units.find(path); unit != units.end()) schema["description"] = "in " + unit->second;
  return schema;
}

}  // namespace

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<std::string> json_of(const ValueLayout& layout, std::string_view bytes) {
  ValueWriter writer(bytes);
  writer.write(layout.root());
  std::optional<std::string> text = std::move(writer).result();
  if (text && layout.root().kind != Node::Kind::structure) text = "{\"value\":" + *text + "}";
  return text;
}

std::string schema_of(const ValueLayout& layout, const std::string& title,
                      const std::map<std::string, std::string>& units) {
  ordered_json schema;
  if (layout.root().kind == Node::Kind::structure) {
    schema = schema_of(layout.root(), "", units);
  } else {
    schema["type"] = "object";
    schema["properties"]["value"] = schema_of(layout.root(), "", units);
  }
  schema["title"] = title;
  return schema.dump();
}

}  // namespace tessera::bag
