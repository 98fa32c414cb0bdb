#include "report/text.hpp"

#include <algorithm>
#include <optional>

namespace tessera::report {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";

struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
};

/// The first character of the text; nullopt: its first byte does not begin a character.
std::optional<Character> first_of(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return std::nullopt;
  char32_t code = lead & (0x7fU >> bytes);
  for (std::size_t at = 1; at < bytes; ++at) {
    if ((byte(at) & 0xc0U) != 0x80) return std::nullopt;
    code = code << 6U | (byte(at) & 0x3fU);
  }
  if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return std::nullopt;
  return Character{code, bytes};
}

bool is_shown(char32_t code) {
  const bool control = (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7f && code < 0xa0);
  const bool turns_direction = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return !control && !turns_direction && code != 0xfeff && (code & 0xfffeU) != 0xfffe;
}

std::string_view entity_of(char32_t code) {
  switch (code) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::optional<Character> character = first_of(text);
    const std::size_t bytes = character ? character->bytes : 1;
    const std::string_view entity = character ? entity_of(character->code) : std::string_view();
    if (!character || !is_shown(character->code))
      result += replacement;
    else
      result += entity.empty() ? text.substr(0, bytes) : entity;
    text.remove_prefix(bytes);
  }
  return result;
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::optional<Character> character = first_of(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (character && is_shown(character->code))
      result += text.substr(0, bytes);
    else
      result += replacement;
    text.remove_prefix(bytes);
  }
  return result;
}

std::string shortened(std::string_view text, std::size_t most_bytes, std::size_t most_lines) {
  std::size_t end = 0;
  for (std::size_t lines = 1; end < text.size(); ++end)
    if (text[end] == '\n' && lines++ == most_lines) break;
  if (end <= most_bytes && end == text.size()) return std::string(text);
  end = std::min(end, most_bytes);
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80) --end;
  return std::string(text.substr(0, end)) + " \u2026";
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, "\u2009");
  }
  return text;
}

std::string data_uri(std::string_view mime, std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:" + std::string(mime) + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      uri += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63U];
  }
  return uri;
}

}  // namespace tessera::report
