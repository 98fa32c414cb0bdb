#include "ros2/codec/translator.hpp"

#include <algorithm>
#include <utility>

#include "ros2/codec/cdr.hpp"
#include "ros2/codec/value_reading.hpp"

namespace tessera::ros2 {
namespace {

/// The number that begins a sequence of the buffer.
std::uint32_t length_of(std::span<const std::byte> part) {
  std::uint32_t length = 0;
  if (part.size() >= sizeof length) std::memcpy(&length, part.data(), sizeof length);
  return length;
}

/// The positions of the blocks of a value; nullopt: the bytes are not such a value.
std::optional<std::vector<std::span<const std::byte>>> parts_of_value(
    std::span<const std::byte> value, const std::vector<Translator::Block>& blocks) {
  std::vector<std::span<const std::byte>> parts;
  parts.reserve(blocks.size());
  for (const Translator::Block& block : blocks) {
    if (block.sequence && block.element >= length_of(parts[*block.sequence])) {
      parts.emplace_back();  // the sequence does not have that element
      continue;
    }
    std::size_t size = 0;
    std::uint32_t count = block.count;
    if (block.is_sequence) {
      if (value.size() < sizeof count) return std::nullopt;
      count = length_of(value);
      if (count > block.count) return std::nullopt;
      size = sizeof count;
    }
    if (block.primitive != Primitive::string) size += size_of(block.primitive) * count;
    for (std::uint32_t index = 0; block.primitive == Primitive::string && index < count; ++index) {
      std::uint32_t length = 0;
      if (value.size() < size + sizeof length) return std::nullopt;
      std::memcpy(&length, value.data() + size, sizeof length);
      size += sizeof length + length;
    }
    if (size > value.size()) return std::nullopt;
    if (block.is_length && length_of(value) > block.capacity) return std::nullopt;
    parts.push_back(value.first(size));
    value = value.subspan(size);
  }
  return value.empty() ? std::optional(std::move(parts)) : std::nullopt;
}

/// In the form of the buffer: unsigned, and little-endian.
void put_number(std::uint64_t number, const Translator::Block& block, std::vector<std::byte>& value) {
  const std::size_t first = value.size(), size = size_of(block.primitive);
  value.resize(first + size);
  std::memcpy(value.data() + first, &number, size);
}

class MessageWriter {
 public:
  MessageWriter(CdrWriter writer, std::vector<std::span<const std::byte>> parts,
                const std::vector<Translator::Block>& blocks, const std::vector<std::string>& names,
                const std::string& frame_id, const Stamp& stamp)
      : writer_(writer),
        parts_(std::move(parts)),
        blocks_(blocks),
        names_(names),
        frame_id_(frame_id),
        stamp_(stamp) {}

  void write(const std::vector<Translator::Step>& steps) {
    if (steps.empty()) writer_.number(&empty_message, 1);
    for (const Translator::Step& step : steps) write(step);
  }
  void finish() { writer_.finish(); }

 private:
  void write(const Translator::Step& step) {
    const bool sequence = step.type.repeat == Type::Repeat::sequence;
    const std::size_t count = count_of(step);
    if (sequence) writer_.length(static_cast<std::uint32_t>(count));
    if (step.type.primitive == Primitive::structure) {
      for (std::size_t index = 0; index < count; ++index)
        write(step.per_element ? step.members[index].members : step.members);
    } else if (step.block) {
      write_block(step.type, *step.block);
    } else {
      write_rest(step, count);
    }
  }

  [[nodiscard]] std::size_t count_of(const Translator::Step& step) const {
    if (step.type.repeat == Type::Repeat::once) return 1;
    if (step.type.repeat == Type::Repeat::array) return step.type.count;
    if (step.block) return count_of(*step.block);
    if (step.length) return length_of(parts_[*step.length]);
    if (step.per_element) return step.members.size();
    return step.fill == Translator::Fill::names ? names_.size() : step.defaults.size();
  }

  /// The number of elements in the value.
  [[nodiscard]] std::size_t count_of(std::size_t block) const {
    return blocks_[block].is_sequence ? length_of(parts_[block]) : blocks_[block].count;
  }

  void write_block(const Type& type, std::size_t number) {
    const Translator::Block& block = blocks_[number];
    const std::size_t count = count_of(number);
    const std::span<const std::byte> part =
        parts_[number].subspan(block.is_sequence ? sizeof(std::uint32_t) : 0);
    if (count == 0) return;
    if (type.primitive != Primitive::string) {
      std::byte* const to = writer_.numbers(size_of(type.primitive), count);
      // A bool of a buffer may be any byte that the compiler takes for true; the message gets 0 or 1.
      static_cast<void>(convert(block.primitive, part.data(), false, type.primitive, to, count));
      return;
    }
    std::size_t at = 0;
    for (std::size_t index = 0; index < count; ++index) {
      std::uint32_t length = 0;
      std::memcpy(&length, part.data() + at, sizeof length);
      at += sizeof length;
      writer_.text({reinterpret_cast<const char*>(part.data()) + at, length});
      at += length;
    }
  }

  void write_rest(const Translator::Step& step, std::size_t count) {
    switch (step.fill) {
      case Translator::Fill::stamp_sec:
        return writer_.number(&stamp_.sec, sizeof stamp_.sec);
      case Translator::Fill::stamp_nanosec:
        return writer_.number(&stamp_.nanosec, sizeof stamp_.nanosec);
      case Translator::Fill::frame_id:
        return writer_.text(frame_id_);
      case Translator::Fill::names:
        for (const std::string& name : names_) writer_.text(name);
        return;
      case Translator::Fill::nothing:
        for (std::size_t index = 0; index < count; ++index)
          write_default(step.type.primitive, step.defaults.empty() ? nullptr : &step.defaults[index]);
    }
  }

  void write_default(Primitive primitive, const Literal* literal) {
    if (primitive == Primitive::string)
      return writer_.text(literal == nullptr ? std::string() : std::get<std::string>(*literal));
    std::byte* const to = writer_.numbers(size_of(primitive), 1);
    if (literal == nullptr) return;
    if (const auto* const flag = std::get_if<bool>(literal)) *to = static_cast<std::byte>(*flag);
    // The lowest bytes of a whole number are the number in a smaller type.
    if (const auto* const whole = std::get_if<std::int64_t>(literal))
      std::memcpy(to, whole, size_of(primitive));
    if (const auto* const natural = std::get_if<std::uint64_t>(literal))
      std::memcpy(to, natural, size_of(primitive));
    if (const auto* const real = std::get_if<double>(literal)) write_real(primitive, *real, to);
  }

  static void write_real(Primitive primitive, double real, std::byte* to) {
    const auto single = static_cast<float>(real);
    if (primitive == Primitive::float32)
      std::memcpy(to, &single, sizeof single);
    else
      std::memcpy(to, &real, sizeof real);
  }

  CdrWriter writer_;
  std::vector<std::span<const std::byte>> parts_;
  const std::vector<Translator::Block>& blocks_;
  const std::vector<std::string>& names_;
  const std::string& frame_id_;
  const Stamp& stamp_;
};

}  // namespace

std::optional<std::uint64_t> Translator::own_value(std::size_t block,
                                                   std::span<const std::uint64_t> own) const {
  const auto field = std::ranges::find(own_, std::optional(block));
  if (field == own_.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(field - own_.begin());
  return index < own.size() ? own[index] : 0;
}

Translator::Outcome Translator::decode(std::span<const std::byte> message, std::vector<std::byte>& value,
                                       std::span<const std::uint64_t> own, Misfit* misfit) const {
  Misfit unasked;
  Misfit& why = misfit == nullptr ? unasked : *misfit;
  // The data may be padded to four bytes. More extra bytes mean another definition of the message.
  constexpr std::size_t most_padding = 3;
  auto reader = CdrReader::open(message);
  if (!reader) return Outcome::malformed;
  PartFinder finder(*reader, blocks_.size());
  finder.walk(steps_);
  if (!reader->ok() || reader->left() > most_padding) return Outcome::malformed;
  if (const PartFinder::Found* const found = finder.misfit()) {
    why = {found->step->array, found->count, found->step->members.size()};
    return Outcome::other_length;
  }
  std::vector<std::size_t> order;
  if (!names_.empty() && !(names_may_be_empty_ && finder.names().count == 0)) {
    auto found = order_of(*reader, finder.names(), names_, why);
    if (!found) return Outcome::other_names;
    order = std::move(*found);
  }
  ValueWriter writer(*reader, why);
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    if (const auto number = own_value(block, own)) {
      put_number(*number, blocks_[block], writer.value());
      continue;
    }
    const Block& one = blocks_[block];
    if (one.sequence && one.element >= finder.blocks()[*one.sequence].count) continue;
    if (one.is_length) {
      writer.add_length(finder.blocks()[block].count);
      continue;
    }
    const Outcome outcome = writer.add(finder.blocks()[block], one, order, finder.names().count);
    if (outcome != Outcome::good) return outcome;
  }
  value = std::move(writer.value());
  return Outcome::good;
}

std::vector<std::byte> Translator::empty_value(std::span<const std::uint64_t> own) const {
  std::vector<std::byte> value;
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    if (const auto number = own_value(block, own)) {
      put_number(*number, blocks_[block], value);
      continue;
    }
    if (blocks_[block].sequence) continue;  // which is empty
    const bool text = blocks_[block].primitive == Primitive::string;
    const std::size_t one = text ? sizeof(std::uint32_t) : size_of(blocks_[block].primitive);
    value.resize(value.size() +
                 (blocks_[block].is_sequence ? sizeof(std::uint32_t) : one * blocks_[block].count));
  }
  return value;
}

std::uint64_t Translator::own_number(std::span<const std::byte> value, std::size_t field) const {
  const auto parts = parts_of_value(value, blocks_);
  if (!own_[field] || !parts) return 0;
  std::uint64_t number = 0;
  std::memcpy(&number, (*parts)[*own_[field]].data(), size_of(blocks_[*own_[field]].primitive));
  return number;
}

bool Translator::encode(std::span<const std::byte> value, const Stamp& stamp,
                        std::vector<std::byte>& message) const {
  auto parts = parts_of_value(value, blocks_);
  if (!parts) return false;
  MessageWriter writer(CdrWriter(message), std::move(*parts), blocks_, names_, frame_id_, stamp);
  writer.write(steps_);
  writer.finish();
  return true;
}

}  // namespace tessera::ros2
