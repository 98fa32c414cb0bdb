#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ros2/definitions/type.hpp"

/// CDR of the first version (XCDR1), as ROS 2 sends messages.
namespace tessera::ros2 {

static_assert(std::endian::native == std::endian::little, "the codec writes numbers as they are in memory");

/// Bytes before the data: the representation, and how much padding follows the data.
inline constexpr std::size_t encapsulation_size = 4;
/// Messages without fields have one byte.
inline constexpr std::uint8_t empty_message = 0;

/// Reads the data behind the encapsulation header. After the first failed read, `ok` stays false, and reads
/// give zeros.
class CdrReader {
 public:
  /// nullopt: the header is not that of plain CDR.
  [[nodiscard]] static std::optional<CdrReader> open(std::span<const std::byte> message);

  [[nodiscard]] bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  [[nodiscard]] bool swapped() const { return swapped_; }
  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  [[nodiscard]] std::size_t left() const { return data_.size() - at_; }

  /// `count` numbers of `size` bytes, aligned; empty if they are not there.
  std::span<const std::byte> numbers(std::size_t size, std::size_t count);
  /// One number in the order of this machine.
  template <class Number>
  [[nodiscard]] Number number() {
    const auto bytes = numbers(sizeof(Number), 1);
    std::array<std::byte, sizeof(Number)> own{};
    if (!bytes.empty()) std::ranges::copy(bytes, own.begin());
    if (swapped_) std::ranges::reverse(own);
    return std::bit_cast<Number>(own);
  }
  [[nodiscard]] std::uint32_t length() { return number<std::uint32_t>(); }
  /// The text without the terminating zero.
  std::string_view text();
  /// Fails for wide strings: their form differs between implementations, so they cannot be skipped.
  void skip(const Type& element, std::size_t count);

 private:
  CdrReader(std::span<const std::byte> data, bool swapped) : data_(data), swapped_(swapped) {}
  std::span<const std::byte> data_;
  std::size_t at_ = 0;
  bool swapped_ = false, ok_ = true;
};

/// Writes little-endian CDR, with its header.
class CdrWriter {
 public:
  explicit CdrWriter(std::vector<std::byte>& to);

  void number(const void* bytes, std::size_t size);
  /// Space for `count` numbers of `size` bytes, aligned and zeroed.
  std::byte* numbers(std::size_t size, std::size_t count);
  void length(std::uint32_t length) { number(&length, sizeof length); }
  void text(std::string_view text);
  /// Pads to four bytes, and notes the padding in the header.
  void finish();

 private:
  std::vector<std::byte>& to_;
};

/// Copies `count` numbers of one type to those of another, which can represent all values of the first. from
/// and to need not be aligned. swapped: the bytes of `from` are in the other order.
///
/// false: a bool that is neither 0 nor 1.
[[nodiscard]] bool convert(Primitive from_type, const std::byte* from, bool swapped, Primitive to_type,
                           std::byte* to, std::size_t count);
/// Whether `to` can represent every value of `from`.
[[nodiscard]] bool converts_exactly(Primitive from, Primitive to);

}  // namespace tessera::ros2
