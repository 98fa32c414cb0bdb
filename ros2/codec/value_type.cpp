#include "ros2/codec/value_type.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "tessera/value_layout.hpp"

namespace tessera::ros2 {
namespace {

using Node = ValueLayout::Node;

/// nullopt: bytes of unknown fields, or a sequence of sequences.
std::optional<Primitive> primitive_of(const Node& node) {
  using Kind = Node::Kind;
  const int doubled = std::countr_zero(node.size);  // from one byte on
  switch (node.kind) {
    case Kind::boolean:
      return Primitive::boolean;
    case Kind::integer:
      return std::array{Primitive::int8, Primitive::int16, Primitive::int32, Primitive::int64}.at(doubled);
    case Kind::natural:
      return std::array{Primitive::uint8, Primitive::uint16, Primitive::uint32, Primitive::uint64}.at(
          doubled);
    case Kind::real:
      return node.size == sizeof(float) ? Primitive::float32 : Primitive::float64;
    case Kind::text:
      return Primitive::string;
    case Kind::structure:
      return Primitive::structure;
    case Kind::bytes:
    case Kind::sequence:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<ValueType> type_of(const Node& node) {
  ValueType type;
  const bool repeated = node.kind == Node::Kind::sequence;
  const Node& one = repeated ? *node.element : node;
  const std::optional<Primitive> primitive = primitive_of(one);
  if (!primitive || (repeated && node.size == 0) || one.size > UINT32_MAX) return std::nullopt;
  type.primitive = *primitive;
  if (one.kind == Node::Kind::text) type.capacity = static_cast<std::uint32_t>(one.size);
  type.count = repeated ? static_cast<std::uint32_t>(node.size) : 0;
  type.is_sequence = node.bounded;
  for (const Node::Field& field : one.fields) {
    std::optional<ValueType> member = type_of(*field.type);
    if (!member) return std::nullopt;
    type.members.push_back({field.name, std::move(*member)});
  }
  return type;
}

}  // namespace

std::string ValueType::text() const {
  std::string text = primitive == Primitive::structure ? "a structure" : name_of(primitive);
  if (primitive == Primitive::string) text += "<=" + std::to_string(capacity);
  if (count > 0 && primitive == Primitive::structure)
    return (is_sequence ? "at most " : "") + std::to_string(count) + " structures";
  if (count == 0) return text;
  return text + (is_sequence ? "<=" + std::to_string(count) : "[" + std::to_string(count) + "]");
}

const ValueType::Member* ValueType::find(std::string_view name) const {
  const auto found = std::ranges::find(members, name, &Member::name);
  return found == members.end() ? nullptr : &*found;
}

std::optional<ValueType> parse_value_type(std::string_view text) {
  const std::optional<ValueLayout> layout = ValueLayout::parse(text);
  return layout ? type_of(layout->root()) : std::nullopt;
}

}  // namespace tessera::ros2
