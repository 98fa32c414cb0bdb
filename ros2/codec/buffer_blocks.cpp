#include "ros2/codec/buffer_blocks.hpp"

#include <algorithm>
#include <utility>

#include "ros2/codec/field_paths.hpp"

namespace tessera::ros2 {

namespace {

constexpr std::size_t most_blocks = 1U << 14;

/// No field has such a name.
std::string length_path(const std::string& path) { return path + "#"; }

}  // namespace

std::optional<BufferBlocks> BufferBlocks::number(const ValueType& value) {
  BufferBlocks blocks;
  blocks.add(value, "", {});
  return blocks.blocks_.size() < most_blocks ? std::optional(std::move(blocks)) : std::nullopt;
}

std::size_t BufferBlocks::length_at(const std::string& path) const { return at(length_path(path)); }

void BufferBlocks::add(const ValueType& type, const std::string& path, const Element& element) {
  if (blocks_.size() >= most_blocks) return;
  if (type.primitive != Primitive::structure) {
    add_block(path, {.primitive = type.primitive,
                     .count = std::max(type.count, 1U),
                     .capacity = type.capacity,
                     .is_sequence = type.is_sequence,
                     .sequence = element.sequence,
                     .element = element.number});
    return;
  }
  std::optional<std::size_t> length;
  if (type.is_sequence) {
    length = blocks_.size();
    add_block(length_path(path), {.primitive = Primitive::uint32,
                                  .capacity = type.count,
                                  .is_length = true,
                                  .sequence = element.sequence,
                                  .element = element.number});
  }
  for (std::uint32_t index = 0; index < std::max(type.count, 1U); ++index)
    for (const ValueType::Member& member : type.members)
      add(member.type, member_path(element_path(path, type, index), member.name),
          length ? Element{length, index} : element);
}

void BufferBlocks::add_block(const std::string& path, Translator::Block block) {
  by_path_.emplace(path, blocks_.size());
  block.path = path.substr(0, path.find('#'));
  blocks_.push_back(std::move(block));
}

std::optional<ElementsOfBuffer> elements_in(const std::string& path, const ValueType& value) {
  const ValueType* type = &value;
  std::string way, rest = path;
  for (const std::string& part : split_path(path)) {
    if (type->count > 0) break;
    const ValueType::Member* const member = type->find(part);
    if (member == nullptr) return std::nullopt;
    type = &member->type;
    way = member_path(way, part);
    rest = rest.substr(std::min(part.size() + 1, rest.size()));
  }
  if (type->count == 0 || type->primitive != Primitive::structure) return std::nullopt;
  return ElementsOfBuffer{type, way, rest};
}

}  // namespace tessera::ros2
