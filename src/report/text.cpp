#include "report/text.hpp"

#include <algorithm>

#include "tessera/printable.hpp"

namespace tessera::report {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";

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
    const Character character = first_character(text);
    if (!character.shown)
      result += replacement;
    else if (const std::string_view entity = entity_of(character.code); !entity.empty())
      result += entity;
    else
      result += text.substr(0, character.bytes);
    text.remove_prefix(character.bytes);
  }
  return result;
}

std::string drawable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    result += character.shown ? text.substr(0, character.bytes) : replacement;
    text.remove_prefix(character.bytes);
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
