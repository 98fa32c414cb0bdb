#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// The first character of a text, or its first byte if no UTF-8 character begins there.
struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
  /// Whether it is visible, a line feed or a tab. Control characters, marks that change the direction of
  /// writing, and bytes that are not UTF-8 are not.
  bool shown = false;
};
/// Precondition: the text is not empty.
[[nodiscard]] Character first_character(std::string_view text);

/// Makes text of user code or of a file safe for a terminal: "\x1b" replaces each byte that is not `shown`,
/// so that it cannot move the cursor, change colours or hide earlier output.
[[nodiscard]] std::string printable(std::string_view text);
/// The same into `room`, cut to its size, without allocation.
[[nodiscard]] std::string_view printable(std::string_view text, std::span<char> room);

}  // namespace tessera
