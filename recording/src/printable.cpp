#include "tessera/printable.hpp"

#include <algorithm>
#include <array>

namespace tessera {
namespace {

[[nodiscard]] bool can_be_seen(char32_t code) {
  const bool control = (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7f && code < 0xa0);
  const bool turns_direction = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return !control && !turns_direction && code != 0xfeff && (code & 0xfffeU) != 0xfffe;
}

/// Calls `put` with each piece of the printable text.
template <class Put>
void in_pieces(std::string_view text, Put put) {
  constexpr std::string_view digits = "0123456789abcdef";
  while (!text.empty()) {
    const Character character = first_character(text);
    if (character.shown) {
      put(text.substr(0, character.bytes));
    } else {
      for (const char byte : text.substr(0, character.bytes)) {
        const auto value = static_cast<unsigned char>(byte);
        const std::array<char, 4> escape{'\\', 'x', digits[value >> 4U], digits[value & 15U]};
        put(std::string_view(escape.data(), escape.size()));
      }
    }
    text.remove_prefix(character.bytes);
  }
}

}  // namespace

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1, can_be_seen(lead)};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
  char32_t code = lead & (0x7fU >> bytes);
  for (std::size_t at = 1; at < bytes; ++at) {
    if ((byte(at) & 0xc0U) != 0x80) return {};
    code = code << 6U | (byte(at) & 0x3fU);
  }
  if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
  return {code, bytes, can_be_seen(code)};
}

std::string printable(std::string_view text) {
  std::string result;
  in_pieces(text, [&](std::string_view piece) { result += piece; });
  return result;
}

std::string_view printable(std::string_view text, std::span<char> room) {
  std::size_t length = 0;
  bool full = false;
  in_pieces(text, [&](std::string_view piece) {
    full = full || piece.size() > room.size() - length;
    if (full) return;
    std::copy(piece.begin(), piece.end(), room.begin() + static_cast<std::ptrdiff_t>(length));
    length += piece.size();
  });
  return {room.data(), length};
}

}  // namespace tessera
