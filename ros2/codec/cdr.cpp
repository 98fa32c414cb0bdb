#include "ros2/codec/cdr.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

namespace tessera::ros2 {
namespace {

std::size_t padding(std::size_t at, std::size_t size) { return (size - at % size) % size; }

/// Calls `use` with a value of the C++ type of a number.
template <class Use>
auto with_number_type(Primitive type, Use use) {
  switch (type) {
    case Primitive::int8:
      return use(std::int8_t{});
    case Primitive::int16:
      return use(std::int16_t{});
    case Primitive::uint16:
      return use(std::uint16_t{});
    case Primitive::int32:
      return use(std::int32_t{});
    case Primitive::uint32:
      return use(std::uint32_t{});
    case Primitive::int64:
      return use(std::int64_t{});
    case Primitive::uint64:
      return use(std::uint64_t{});
    case Primitive::float32:
      return use(float{});
    case Primitive::float64:
      return use(double{});
    default:
      return use(std::uint8_t{});
  }
}

template <class From, class To>
void convert_numbers(const std::byte* from, bool swapped, std::byte* to, std::size_t count) {
  for (std::size_t index = 0; index < count; ++index) {
    std::array<std::byte, sizeof(From)> bytes;
    std::memcpy(bytes.data(), from + index * sizeof(From), sizeof(From));
    if (swapped) std::ranges::reverse(bytes);
    From number;
    std::memcpy(&number, bytes.data(), sizeof(From));
    const auto converted = static_cast<To>(number);
    std::memcpy(to + index * sizeof(To), &converted, sizeof(To));
  }
}

bool are_bools(const std::byte* from, std::size_t count) {
  return std::all_of(from, from + count, [](std::byte one) { return one <= std::byte{1}; });
}

struct NumberFacts {
  int digits;  ///< bits of a whole number up to which all values fit
  bool is_signed, real;
};
NumberFacts facts_of(Primitive type) {
  return with_number_type(type, [](auto number) {
    using Number = decltype(number);
    return NumberFacts{std::numeric_limits<Number>::digits, std::is_signed_v<Number>,
                       std::is_floating_point_v<Number>};
  });
}

}  // namespace

std::optional<CdrReader> CdrReader::open(std::span<const std::byte> message) {
  if (message.size() < encapsulation_size || message[0] != std::byte{0} || message[1] > std::byte{1})
    return std::nullopt;
  return CdrReader(message.subspan(encapsulation_size), message[1] == std::byte{0});
}

std::span<const std::byte> CdrReader::numbers(std::size_t size, std::size_t count) {
  if (!ok_ || count == 0) return {};
  const std::size_t gap = padding(at_, size);
  if (gap > left() || count > (left() - gap) / size) {
    ok_ = false;
    return {};
  }
  const auto found = data_.subspan(at_ + gap, size * count);
  at_ += gap + size * count;
  return found;
}

std::string_view CdrReader::text() {
  const std::uint32_t size = length();
  if (!ok_ || size == 0) return {};  // some implementations write an empty string without its zero
  if (size > left() || data_[at_ + size - 1] != std::byte{0}) {
    ok_ = false;
    return {};
  }
  const std::string_view found(reinterpret_cast<const char*>(data_.data()) + at_, size - 1);
  at_ += size;
  return found;
}

void CdrReader::skip(const Type& element, std::size_t count) {
  if (element.primitive == Primitive::wstring) ok_ = false;
  if (element.primitive != Primitive::string) {
    numbers(std::max<std::size_t>(size_of(element.primitive), 1), count);
    return;
  }
  for (std::size_t index = 0; index < count && ok_; ++index) {
    const std::string_view found = text();
    if (element.string_bound > 0 && found.size() > element.string_bound) ok_ = false;
  }
}

CdrWriter::CdrWriter(std::vector<std::byte>& to) : to_(to) {
  to_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
}

std::byte* CdrWriter::numbers(std::size_t size, std::size_t count) {
  if (count == 0) return nullptr;
  const std::size_t first = to_.size() + padding(to_.size() - encapsulation_size, size);
  to_.resize(first + size * count);
  return to_.data() + first;
}

void CdrWriter::number(const void* bytes, std::size_t size) { std::memcpy(numbers(size, 1), bytes, size); }

void CdrWriter::text(std::string_view text) {
  length(static_cast<std::uint32_t>(text.size() + 1));
  std::byte* const to = numbers(1, text.size() + 1);
  std::copy_n(reinterpret_cast<const std::byte*>(text.data()), text.size(), to);
}

void CdrWriter::finish() {
  const std::size_t gap = padding(to_.size(), 4);
  to_[3] = static_cast<std::byte>(gap);
  to_.resize(to_.size() + gap);
}

bool convert(Primitive from_type, const std::byte* from, bool swapped, Primitive to_type, std::byte* to,
             std::size_t count) {
  if (from_type == Primitive::boolean && !are_bools(from, count)) return false;
  if (from_type == to_type && (!swapped || size_of(from_type) == 1)) {
    std::copy_n(from, count * size_of(from_type), to);
    return true;
  }
  with_number_type(from_type, [&](auto source) {
    with_number_type(to_type, [&](auto target) {
      convert_numbers<decltype(source), decltype(target)>(from, swapped, to, count);
    });
  });
  return true;
}

bool converts_exactly(Primitive from, Primitive to) {
  if (from == to) return true;
  if (from == Primitive::boolean || to == Primitive::boolean || from > Primitive::float64 ||
      to > Primitive::float64)
    return false;
  const NumberFacts source = facts_of(from), target = facts_of(to);
  return source.digits <= target.digits && (target.is_signed || !source.is_signed) &&
         (target.real || !source.real);
}

}  // namespace tessera::ros2
