#include "explore/encoding.hpp"

#include <algorithm>
#include <bit>

namespace tessera::explore {
namespace {

constexpr std::uint32_t word_bits = 64;
constexpr std::uint8_t widest_counter = 32;  // the width of Tokens

}  // namespace

Encoding::Encoding(const PtNet& net, const std::vector<Unit>& units, const std::vector<std::uint8_t>& widths)
    : slots_(net.places()), free_bits_{word_bits} {
  std::vector<char> in_unit(net.places(), 0);
  for (const Unit& unit : units) {
    const Word none = unit.always_one ? 0 : 1;  // if not, code 0 means that no place is marked
    const std::uint32_t field =
        add_field(static_cast<std::uint32_t>(std::bit_width(unit.places.size() - 1 + none)));
    for (std::size_t index = 0; index < unit.places.size(); ++index) {
      slots_[unit.places[index]] = {Kind::unit, field, index + none};
      in_unit[unit.places[index]] = 1;
    }
  }
  for (std::uint32_t place = 0; place < net.places(); ++place) {
    if (in_unit[place] != 0) continue;
    proves_safe_ = false;
    const bool bit = widths[place] == 1;
    slots_[place] = {bit ? Kind::bit : Kind::counter, add_field(bit ? 1U : widths[place] + 1U), 1};
  }
  words_ = static_cast<std::uint32_t>(free_bits_.size());
}

/// First fit: few fields are wide, so little space is lost at the ends of words. Only the last words are
/// tried, so that this stays linear.
std::uint32_t Encoding::add_field(std::uint32_t width) {
  constexpr std::size_t tried = 4;
  std::size_t word = free_bits_.size() - std::min(tried, free_bits_.size());
  while (word < free_bits_.size() && free_bits_[word] < width) ++word;
  if (word == free_bits_.size()) free_bits_.push_back(word_bits);
  // A field of width 0 at the end of a full word would be shifted by 64.
  const std::uint32_t shift = width == 0 ? 0 : word_bits - free_bits_[word];
  fields_.push_back({static_cast<std::uint32_t>(word), shift, width});
  free_bits_[word] -= width;
  return static_cast<std::uint32_t>(fields_.size() - 1);
}

Tokens Encoding::tokens(std::uint32_t place, std::span<const Word> words) const {
  const Slot& slot = slots_[place];
  const Word value = fields_[slot.field].of(words);
  return slot.kind == Kind::counter ? static_cast<Tokens>(value) : Tokens{value == slot.code};
}

void Encoding::decode(std::span<const Word> words, std::span<Tokens> marking) const {
  for (std::uint32_t place = 0; place < slots_.size(); ++place) marking[place] = tokens(place, words);
}

std::optional<std::uint32_t> Encoding::encode(std::span<const Tokens> marking, std::span<Word> words) const {
  for (std::uint32_t place = 0; place < slots_.size(); ++place) {
    const Slot& slot = slots_[place];
    const Field& field = fields_[slot.field];
    const Tokens tokens = marking[place];
    if (slot.kind == Kind::counter) {
      if (static_cast<std::uint32_t>(std::bit_width(tokens)) >= field.width) return place;
      words[field.word] |= Word{tokens} << field.shift;
    } else {
      if (tokens > 1) return place;
      if (tokens == 1) words[field.word] |= slot.code << field.shift;
    }
  }
  return std::nullopt;
}

Growth::Growth(const PtNet& net) : net_(net), units_(find_units(net)), widths_(net.places(), 1) {
  // Tokens move: the tokens that one place holds at first may later be in others.
  Tokens most = 1;
  for (const Tokens tokens : net.initial()) most = std::max(most, tokens);
  for (std::uint32_t place = 0; place < net.places(); ++place) {
    Tokens needed = std::min<Tokens>(most, 255);
    for (const Touch& touch : net.of_place(place))
      needed = std::max({needed, touch.consumes, touch.produces});
    needed = std::max(needed, net.initial()[place]);
    widths_[place] = static_cast<std::uint8_t>(std::bit_width(needed));
  }
}

bool Growth::widen(std::uint32_t place) {
  if (widths_[place] == widest_counter) return false;
  ++widths_[place];
  return true;
}

}  // namespace tessera::explore
