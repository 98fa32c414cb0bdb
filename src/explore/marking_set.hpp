#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>

#include "explore/encoding.hpp"
#include "explore/zeroed_memory.hpp"

namespace tessera::explore {

/// A marking is identified by its position in the order of insertion.
using Index = std::uint32_t;
inline constexpr std::size_t most_markings = std::numeric_limits<Index>::max() - 1;

template <std::size_t W>
using Packed = std::array<Word, W>;

/// A set of packed markings of W words, in the order of insertion.
///
/// Memory: W words per marking, stored once and in order, and a table of 4-byte slots (4.7 to 7.1
///         bytes per marking). A slot holds an index and, in the remaining bits, a part of the hash.
///         When the table is full, it is rebuilt from the markings, so that the old and the new
///         table never exist together.
///
/// Prefetching: call `prefetch_slot` for many markings, then `prefetch_marking`, then `insert` or `find`,
///              so that the cache misses overlap.
///
/// Threads: const members from any thread.
template <std::size_t W>
class MarkingSet {
 public:
  MarkingSet() { rebuild(first_capacity); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Packed<W>& operator[](Index index) const { return markings()[index]; }
  /// Memory in use.
  [[nodiscard]] std::size_t bytes() const { return size_ * sizeof(Packed<W>) + capacity_ * sizeof(Slot); }
  /// The value of bytes() after `more` insertions.
  [[nodiscard]] std::size_t bytes_after(std::size_t more) const {
    const std::size_t capacity = fits(more) ? capacity_ : grown(size_ + more);
    return (size_ + more) * sizeof(Packed<W>) + capacity * sizeof(Slot);
  }
  /// Makes room. Indices stay valid, references do not.
  void reserve(std::size_t more) {
    if ((size_ + more) * sizeof(Packed<W>) > arena_.size())
      arena_.grow((size_ + more) * sizeof(Packed<W>) * 3 / 2);
    if (!fits(more)) rebuild(grown(size_ + more));
  }

  [[nodiscard]] static std::uint64_t hash(const Packed<W>& words) {
    std::uint64_t mixed = 0x9E3779B97F4A7C15U;
    for (const Word word : words) mixed = folded_product(mixed ^ word, 0xD6E8FEB86659FD93U);
    return folded_product(mixed, 0xA0761D6478BD642FU);
  }

  void prefetch_slot(std::uint64_t hash) const { __builtin_prefetch(table() + first_slot(hash)); }
  void prefetch_marking(std::uint64_t hash) const {
    const Slot slot = table()[first_slot(hash)];
    if (slot != empty && same_part(slot, hash)) __builtin_prefetch(markings() + index_in(slot));
  }

  struct Insertion {
    Index index;
    bool fresh;
  };
  /// Precondition: reserve(). `words` is not in the set's own memory.
  Insertion insert(const Packed<W>& words, std::uint64_t hash) {
    std::size_t at = first_slot(hash);
    for (; table()[at] != empty; at = next(at))
      if (is(table()[at], words, hash)) return {index_in(table()[at]), false};
    table()[at] = slot_of(static_cast<Index>(size_), hash);
    markings()[size_] = words;
    return {static_cast<Index>(size_++), true};
  }
  [[nodiscard]] std::optional<Index> find(const Packed<W>& words, std::uint64_t hash) const {
    for (std::size_t at = first_slot(hash); table()[at] != empty; at = next(at))
      if (is(table()[at], words, hash)) return index_in(table()[at]);
    return std::nullopt;
  }

 private:
  using Slot = std::uint32_t;  // 0, or index + 1 in the low bits and a part of the hash above
  static constexpr Slot empty = 0;
  static constexpr std::size_t first_capacity = 1024;

  static std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = Wide{a} * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
  }
  static std::size_t most_in(std::size_t capacity) { return capacity - capacity * 3 / 20; }
  static std::size_t grown(std::size_t markings) {
    return markings + markings / 2 + markings / 4 + first_capacity;
  }

  [[nodiscard]] bool fits(std::size_t more) const { return size_ + more <= most_in(capacity_); }
  [[nodiscard]] std::size_t first_slot(std::uint64_t hash) const {
    return static_cast<std::size_t>(((hash >> 32U) * capacity_) >> 32U);
  }
  [[nodiscard]] std::size_t next(std::size_t at) const { return at + 1 == capacity_ ? 0 : at + 1; }
  [[nodiscard]] Slot slot_of(Index index, std::uint64_t hash) const {
    return (static_cast<Slot>(hash) & ~index_mask_) | (index + 1);
  }
  [[nodiscard]] bool same_part(Slot slot, std::uint64_t hash) const {
    return ((slot ^ static_cast<Slot>(hash)) & ~index_mask_) == 0;
  }
  [[nodiscard]] Index index_in(Slot slot) const { return (slot & index_mask_) - 1; }
  [[nodiscard]] bool is(Slot slot, const Packed<W>& words, std::uint64_t hash) const {
    return same_part(slot, hash) && markings()[index_in(slot)] == words;
  }

  void rebuild(std::size_t capacity) {
    table_.release();
    table_.grow(capacity * sizeof(Slot));
    capacity_ = capacity;
    index_mask_ = static_cast<Slot>((std::uint64_t{1} << std::bit_width(most_in(capacity) + 1)) - 1);
    constexpr std::size_t ahead = 16;
    std::array<std::uint64_t, ahead> hashes{};
    for (std::size_t index = 0; index < size_ + ahead; ++index) {
      std::uint64_t& hash_at = hashes[index % ahead];
      if (index >= ahead) {
        std::size_t at = first_slot(hash_at);
        while (table()[at] != empty) at = next(at);
        table()[at] = slot_of(static_cast<Index>(index - ahead), hash_at);
      }
      if (index >= size_) continue;
      hash_at = hash(markings()[index]);
      __builtin_prefetch(table() + first_slot(hash_at), 1);
    }
  }

  [[nodiscard]] Packed<W>* markings() const { return static_cast<Packed<W>*>(arena_.data()); }
  [[nodiscard]] Slot* table() const { return static_cast<Slot*>(table_.data()); }

  ZeroedMemory arena_, table_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  Slot index_mask_ = 0;
};

}  // namespace tessera::explore
