#pragma once

#include <cstddef>

#include "diagnostics/diagnostics.hpp"

namespace tessera::spec {

/// The longest line that is read. Real specifications have no longer ones, and reading one takes seconds.
inline constexpr std::size_t longest_line = std::size_t{1024} * 1024;

/// Whether a letter only separates others.
[[nodiscard]] constexpr bool is_blank(char letter) {
  return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\n';
}

/// Whether out.text() is a text and not binary data.
///
/// Errors: E003 control characters (a binary file), E004 not UTF-8, E005 XML, E011 a line longer than longest_line
///         bytes. Reports the first of its kind only.
[[nodiscard]] bool check_text(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
