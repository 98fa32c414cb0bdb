#include "diagnostics/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace tessera::diagnostics {
namespace {

struct Range {
  char32_t first, last;
};

/// Combining marks, zero-width characters and variation selectors.
constexpr std::array zero_width = {Range{0x300, 0x36F},   Range{0x483, 0x489},   Range{0x591, 0x5BD},
                                   Range{0x200B, 0x200F}, Range{0x20D0, 0x20FF}, Range{0xFE00, 0xFE0F},
                                   Range{0xFEFF, 0xFEFF}};

/// East Asian wide characters and emoji.
constexpr std::array wide = {Range{0x1100, 0x115F},   Range{0x2E80, 0xA4CF},   Range{0xAC00, 0xD7A3},
                             Range{0xF900, 0xFAFF},   Range{0xFE30, 0xFE6F},   Range{0xFF00, 0xFF60},
                             Range{0xFFE0, 0xFFE6},   Range{0x1F300, 0x1F64F}, Range{0x1F680, 0x1F6FF},
                             Range{0x1F900, 0x1F9FF}, Range{0x20000, 0x3FFFD}};

/// Controls, and marks that reorder text. Printed unchanged, they could make a
/// terminal show a different text.
constexpr std::array hidden = {Range{0x80, 0x9F}, Range{0x2028, 0x202E}, Range{0x2066, 0x2069}};

template <std::size_t N>
bool contains(const std::array<Range, N>& ranges, char32_t code) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [code](const Range& range) { return range.first <= code && code <= range.last; });
}

std::string spelled(const char* format, char32_t code) {
  std::array<char, 16> buffer{};
  const int size = std::snprintf(buffer.data(), buffer.size(), format, static_cast<unsigned>(code));
  return {buffer.data(), static_cast<std::size_t>(size)};
}

std::string encode(char32_t code) {
  const auto low = [code](unsigned shift) { return static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0U | (code >> 6U)), low(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0U | (code >> 12U)), low(6), low(0)};
  return {static_cast<char>(0xF0U | (code >> 18U)), low(12), low(6), low(0)};
}

}  // namespace

CodePoint decode(std::string_view text, std::size_t position) {
  const auto byte = [&](std::size_t offset) -> unsigned {
    return position + offset < text.size() ? static_cast<unsigned char>(text[position + offset]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const CodePoint bad{first, 1, false};
  const unsigned length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return bad;
  char32_t code = first & (0x7FU >> length);
  for (unsigned i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return bad;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (overlong || (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF) return bad;
  return {code, static_cast<std::uint8_t>(length), true};
}

std::optional<std::size_t> first_invalid_byte(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint point = decode(text, i);
    if (!point.valid) return i;
    i += point.length;
  }
  return std::nullopt;
}

Glyph glyph(const CodePoint& point) {
  const char32_t code = point.code;
  if (point.valid && code == '\t') return {" ", 1};
  if (!point.valid || code < 0x20 || code == 0x7F) return {spelled("\\x%02X", code), 4};
  if (contains(hidden, code)) {
    std::string text = spelled("<U+%04X>", code);
    return {text, static_cast<unsigned>(text.size())};
  }
  return {encode(code), contains(zero_width, code) ? 0U : contains(wide, code) ? 2U : 1U};
}

std::string visible(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint point = decode(text, i);
    result += glyph(point).text;
    i += point.length;
  }
  return result;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 70;
  constexpr std::size_t kept = 60;
  if (word.size() <= longest) return "'" + visible(word) + "'";
  std::size_t end = kept;
  while ((static_cast<unsigned char>(word[end]) & 0xC0U) == 0x80U && end > kept - 4) --end;
  return "'" + visible(word.substr(0, end)) + "...'";
}

}  // namespace tessera::diagnostics
