#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// The first character of a text, or its first byte if that begins no character of UTF-8.
struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
  /// It can be seen, or is a line feed or a tab: no control character, no mark that changes the direction of
  /// writing, no byte that is not UTF-8.
  bool shown = false;
};
/// Precondition: there is text.
[[nodiscard]] Character first_character(std::string_view text);

/// Text of user code or of a file, for a terminal: "\x1b" in place of each byte that is not `shown`, so that it
/// cannot move the cursor, change colours or hide what was printed before.
[[nodiscard]] std::string printable(std::string_view text);
/// The same into `room`, as far as it goes, without allocation.
[[nodiscard]] std::string_view printable(std::string_view text, std::span<char> room);

}  // namespace tessera
