#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "explore/pt_net.hpp"
#include "explore/units.hpp"

namespace tessera::explore {

using Word = std::uint64_t;

/// A run of bits of a marking; it never crosses a word.
struct Field {
  std::uint32_t word = 0;
  std::uint32_t shift = 0;
  std::uint32_t width = 0;  ///< bits; 0 for a unit of one place that is always marked

  [[nodiscard]] Word mask() const { return ((Word{1} << width) - 1) << shift; }
  [[nodiscard]] Word of(std::span<const Word> words) const { return (words[word] & mask()) >> shift; }
};

/// How markings of a net are packed into words.
///
/// A unit becomes one number, which of its places is marked. Places of no unit have a field each: one bit as
/// long as no run was seen to put a second token there, else a counter below a guard bit, which is 0 in every
/// marking and tells when a sum outgrows its field. An outgrown field is widened and the exploration repeated
/// (Growth).
class Encoding {
 public:
  enum class Kind : std::uint8_t {
    unit,    ///< the field holds `code` when the place is marked
    bit,     ///< not known to be safe, one token at most so far
    counter  ///< tokens, and a guard bit above them
  };
  struct Slot {
    Kind kind = Kind::bit;
    std::uint32_t field = 0;  ///< into fields()
    Word code = 1;            ///< of a unit or bit
  };

  /// widths: per place of no unit, the bits of its count (see Growth).
  Encoding(const PtNet& net, const std::vector<Unit>& units, const std::vector<std::uint8_t>& widths);

  [[nodiscard]] std::uint32_t words() const { return words_; }
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  [[nodiscard]] const Slot& of(std::uint32_t place) const { return slots_[place]; }
  /// Every place is in a unit: the net is safe, and no field can be outgrown.
  [[nodiscard]] bool proves_safe() const { return proves_safe_; }

  [[nodiscard]] Tokens tokens(std::uint32_t place, std::span<const Word> words) const;
  void decode(std::span<const Word> words, std::span<Tokens> marking) const;
  /// words: all zero at first. The place whose field the marking outgrows, if there is one.
  [[nodiscard]] std::optional<std::uint32_t> encode(std::span<const Tokens> marking,
                                                    std::span<Word> words) const;

 private:
  std::uint32_t add_field(std::uint32_t width);

  std::vector<Slot> slots_;
  std::vector<Field> fields_;
  std::vector<std::uint32_t> free_bits_;  // per word
  std::uint32_t words_ = 1;
  bool proves_safe_ = true;
};

/// The field widths of a net whose bounds are not known: they start with what the net shows and grow with
/// what its runs do.
class Growth {
 public:
  explicit Growth(const PtNet& net);
  [[nodiscard]] Encoding encoding() const { return {net_, units_, widths_}; }
  /// False if the place holds more tokens than can be counted.
  [[nodiscard]] bool widen(std::uint32_t place);

 private:
  const PtNet& net_;
  std::vector<Unit> units_;
  std::vector<std::uint8_t> widths_;
};

}  // namespace tessera::explore
