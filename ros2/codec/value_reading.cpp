#include "ros2/codec/value_reading.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera::ros2 {

void PartFinder::walk(const std::vector<Translator::Step>& steps) {
  if (steps.empty()) reader_.numbers(1, 1);
  for (const Translator::Step& step : steps) {
    if (!reader_.ok()) return;
    walk(step);
  }
}

void PartFinder::walk(const Translator::Step& step) {
  using Repeat = Type::Repeat;
  std::size_t count = step.type.repeat == Repeat::once ? 1 : step.type.count;
  if (step.type.repeat == Repeat::sequence) {
    count = reader_.length();
    if (step.type.count > 0 && count > step.type.count) reader_.fail();
  }
  if (!reader_.ok()) return;
  if (step.type.primitive != Primitive::structure) {
    const Found found{reader_.at(), count, &step};
    if (step.block) blocks_[*step.block] = found;
    if (step.fill == Translator::Fill::names) names_ = found;
    reader_.skip(step.type, count);
  } else if (step.per_element && (step.length ? count > step.members.size() : count != step.members.size())) {
    if (!misfit_) misfit_ = Found{reader_.at(), count, &step};
    for (std::size_t index = 0; index < count && reader_.ok(); ++index) walk(step.members.front().members);
  } else {
    if (step.length) blocks_[*step.length] = {reader_.at(), count, &step};
    for (std::size_t index = 0; index < count && reader_.ok(); ++index)
      walk(step.per_element ? step.members[index].members : step.members);
  }
}

std::optional<std::vector<std::size_t>> order_of(CdrReader& reader, const PartFinder::Found& found,
                                                 const std::vector<std::string>& names,
                                                 Translator::Misfit& misfit) {
  constexpr std::size_t nowhere = ~std::size_t{0};
  std::vector<std::size_t> order(names.size(), nowhere);
  reader.go_to(found.at);
  for (std::size_t index = 0; index < found.count; ++index) {
    const auto name = std::ranges::find(names, reader.text());
    if (name == names.end()) continue;
    std::size_t& place = order[static_cast<std::size_t>(name - names.begin())];
    if (place != nowhere) return misfit = {.field = *name, .came = 2, .room = 1}, std::nullopt;
    place = index;
  }
  if (const auto missing = std::ranges::find(order, nowhere); missing != order.end())
    return misfit = {.field = names[static_cast<std::size_t>(missing - order.begin())], .room = 1},
           std::nullopt;
  return order;
}

Translator::Outcome ValueWriter::add(const PartFinder::Found& found, const Translator::Block& block,
                                     const std::vector<std::size_t>& order, std::size_t names) {
  // A trajectory may leave out all velocities: such a sequence of the buffer is empty.
  const bool by_name = found.step->by_name && !order.empty() && !(block.is_sequence && found.count == 0);
  if (found.step->by_name && order.empty() && found.count > 0) {  // elements without their names
    misfit_ = {block.path, found.count, 0};
    return Translator::Outcome::other_length;
  }
  const std::size_t room = by_name ? names : block.count;
  if (block.is_sequence && !by_name ? found.count > room : found.count != room) {
    misfit_ = {block.path, found.count, room};
    return Translator::Outcome::other_length;
  }
  const std::size_t count = by_name || !block.is_sequence ? block.count : found.count;
  if (block.is_sequence) add_length(count);
  reader_.go_to(found.at);
  const std::vector<std::size_t>* const used = by_name ? &order : nullptr;
  return block.primitive == Primitive::string ? add_texts(found, block, count, used)
                                              : add_numbers(found, block, count, used);
}

void ValueWriter::add_length(std::size_t count) {
  const auto length = static_cast<std::uint32_t>(count);
  put(&length, sizeof length);
}

Translator::Outcome ValueWriter::add_numbers(const PartFinder::Found& found, const Translator::Block& block,
                                             std::size_t count, const std::vector<std::size_t>* order) {
  const Primitive source = found.step->type.primitive;
  const auto bytes = reader_.numbers(size_of(source), found.count);
  const std::size_t first = value_.size(), size = size_of(block.primitive);
  value_.resize(first + size * count);
  bool good = true;
  if (order == nullptr && count > 0)
    good = convert(source, bytes.data(), reader_.swapped(), block.primitive, value_.data() + first, count);
  for (std::size_t index = 0; order != nullptr && index < count; ++index)
    good = convert(source, bytes.data() + (*order)[index] * size_of(source), reader_.swapped(),
                   block.primitive, value_.data() + first + index * size, 1) &&
           good;
  return good ? Translator::Outcome::good : Translator::Outcome::malformed;
}

Translator::Outcome ValueWriter::add_texts(const PartFinder::Found& found, const Translator::Block& block,
                                           std::size_t count, const std::vector<std::size_t>* order) {
  std::vector<std::string_view> texts(found.count);
  for (std::string_view& text : texts) text = reader_.text();
  for (std::size_t index = 0; index < count; ++index) {
    const std::string_view text = texts[order == nullptr ? index : (*order)[index]];
    if (text.size() > block.capacity) {
      misfit_ = {block.path, text.size(), block.capacity, /*is_text=*/true};
      return Translator::Outcome::other_length;
    }
    const auto length = static_cast<std::uint32_t>(text.size());
    put(&length, sizeof length);
    put(text.data(), text.size());
  }
  return Translator::Outcome::good;
}

void ValueWriter::put(const void* bytes, std::size_t count) {
  const auto* const first = static_cast<const std::byte*>(bytes);
  value_.insert(value_.end(), first, first + count);
}

}  // namespace tessera::ros2
