#include "ros2/codec/message_copy.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tessera::ros2 {
namespace {

void copy_elements(const Type& type, std::size_t count, CdrReader& from, CdrWriter& to) {
  if (type.primitive == Primitive::structure) {
    for (std::size_t index = 0; index < count && from.ok(); ++index) copy_message(*type.structure, from, to);
    return;
  }
  if (type.primitive == Primitive::wstring) return from.fail();
  if (type.primitive == Primitive::string) {
    for (std::size_t index = 0; index < count && from.ok(); ++index) to.text(from.text());
    return;
  }
  const auto numbers = from.numbers(size_of(type.primitive), count);
  if (numbers.empty()) return;
  std::byte* const written = to.numbers(size_of(type.primitive), count);
  if (!convert(type.primitive, numbers.data(), from.swapped(), type.primitive, written, count)) from.fail();
}

}  // namespace

void copy_message(const Structure& type, CdrReader& from, CdrWriter& to) {
  if (type.fields.empty()) {
    static_cast<void>(from.numbers(1, 1));
    to.number(&empty_message, 1);
  }
  for (const Field& field : type.fields) {
    if (!from.ok()) return;
    std::size_t count = std::max<std::uint32_t>(field.type.count, 1);
    if (field.type.repeat == Type::Repeat::sequence) {
      const std::uint32_t length = from.length();
      to.length(length);
      count = length;
    }
    copy_elements(field.type, count, from, to);
  }
}

void write_empty_message(const Structure& type, CdrWriter& to) {
  if (type.fields.empty()) to.number(&empty_message, 1);
  for (const Field& field : type.fields) {
    if (field.type.repeat == Type::Repeat::sequence) {
      to.length(0);
      continue;
    }
    const std::size_t count = std::max<std::uint32_t>(field.type.count, 1);
    if (size_of(field.type.primitive) > 0) {
      to.numbers(size_of(field.type.primitive), count);
      continue;
    }
    for (std::size_t index = 0; index < count; ++index)
      field.type.primitive == Primitive::structure ? write_empty_message(*field.type.structure, to)
                                                   : to.text("");
  }
}

}  // namespace tessera::ros2
