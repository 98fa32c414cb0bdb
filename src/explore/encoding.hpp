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
/// A unit becomes one number, which says which of its places is marked. A place outside all units has a
/// field of its own. The field is one bit as long as no run has put a second token there. Otherwise it is a
/// counter below a guard bit, which is 0 in every marking and shows when a sum overflows its field. A field
/// that is too small is widened, and the exploration is repeated (Growth).
class Encoding {
 public:
  enum class Kind : std::uint8_t {
    unit,    ///< the field holds `code` when the place is marked
    bit,     ///< at most one token so far, but not known to be safe
    counter  ///< tokens, and a guard bit above them
  };
  struct Slot {
    Kind kind = Kind::bit;
    std::uint32_t field = 0;  ///< into fields()
    Word code = 1;            ///< of a unit or bit
  };

  /// widths: for each place outside all units, the bits of its counter (see Growth).
  Encoding(const PtNet& net, const std::vector<Unit>& units, const std::vector<std::uint8_t>& widths);

  [[nodiscard]] std::uint32_t words() const { return words_; }
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  [[nodiscard]] const Slot& of(std::uint32_t place) const { return slots_[place]; }
  /// Whether every place is in a unit. Then the net is safe, and no field can overflow.
  [[nodiscard]] bool proves_safe() const { return proves_safe_; }

  [[nodiscard]] Tokens tokens(std::uint32_t place, std::span<const Word> words) const;
  void decode(std::span<const Word> words, std::span<Tokens> marking) const;
  /// words: all zero at first. Returns the place whose field is too small for the marking, if there is one.
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

/// The field widths of a net whose bounds are not known. They begin with the initial marking
/// and grow when runs need more.
class Growth {
 public:
  explicit Growth(const PtNet& net);
  [[nodiscard]] Encoding encoding() const { return {net_, units_, widths_}; }
  /// false: the place holds more tokens than can be counted.
  [[nodiscard]] bool widen(std::uint32_t place);

 private:
  const PtNet& net_;
  std::vector<Unit> units_;
  std::vector<std::uint8_t> widths_;
};

}  // namespace tessera::explore
