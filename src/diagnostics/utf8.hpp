#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tessera::diagnostics {

/// One code point of a text, or one byte that is not UTF-8 (valid is false, and code is the byte).
struct CodePoint {
  char32_t code = 0;
  std::uint8_t length = 1;  ///< bytes
  bool valid = true;
};

/// The code point at byte `position` < text.size(). Overlong forms, surrogates and values
/// above U+10FFFF are invalid.
[[nodiscard]] CodePoint decode(std::string_view text, std::size_t position);

/// The position of the first byte that is not UTF-8.
[[nodiscard]] std::optional<std::size_t> first_invalid_byte(std::string_view text);

/// How a code point looks in a terminal.
struct Glyph {
  std::string text;      ///< never a control character: those are spelled "\x1B" or "<U+202E>"
  unsigned columns = 1;  ///< terminal columns it takes
};

/// A tab becomes one space here: only the caller knows the column.
[[nodiscard]] Glyph glyph(const CodePoint& point);

/// `text` with every control character and invalid byte spelled out.
[[nodiscard]] std::string visible(std::string_view text);

/// `word` in quotes for a message: visible and, if long, shortened.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace tessera::diagnostics
