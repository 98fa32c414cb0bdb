#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tessera::explore {

/// A set of markings of a graph, one bit each.
class Bits {
 public:
  explicit Bits(std::size_t size) : words_((size + 63) / 64), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool operator[](std::size_t at) const { return ((words_[at / 64] >> (at % 64)) & 1U) != 0; }
  void set(std::size_t at) { words_[at / 64] |= std::uint64_t{1} << (at % 64); }
  [[nodiscard]] std::size_t bytes() const { return words_.size() * sizeof(std::uint64_t); }

  /// The first member at or after position `at`.
  [[nodiscard]] std::optional<std::uint32_t> next(std::size_t at) const {
    for (std::size_t word = at / 64; word < words_.size(); ++word) {
      std::uint64_t rest = words_[word];
      if (word == at / 64) rest &= ~std::uint64_t{0} << (at % 64);
      if (rest != 0)
        return static_cast<std::uint32_t>(word * 64 + static_cast<unsigned>(std::countr_zero(rest)));
    }
    return std::nullopt;
  }
  [[nodiscard]] Bits complement() const {
    Bits result(size_);
    for (std::size_t word = 0; word < words_.size(); ++word) result.words_[word] = ~words_[word];
    if (size_ % 64 != 0) result.words_.back() &= (std::uint64_t{1} << (size_ % 64)) - 1;
    return result;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

}  // namespace tessera::explore
