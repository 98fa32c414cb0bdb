#pragma once

#include <string>
#include <string_view>

#include "language/text/lines.hpp"

/// Scalars of a YAML text that may be unfinished. Every function takes any text and position.
namespace tessera::language {

/// A key without quotes, and the byte behind it and the blanks that follow. There is a ':' unless the key is
/// unfinished.
struct Key {
  std::string text;
  Extent extent;
  std::size_t after = 0;
};
/// in_flow: inside { } or [ ], where commas and brackets end it.
[[nodiscard]] Key scan_key(std::string_view text, std::size_t at, bool in_flow);

struct ScalarText {
  std::string text;
  Extent extent;
  std::size_t after = 0;
  bool quoted = false;
};
/// least: the indentation that further lines of the scalar need.
[[nodiscard]] ScalarText scan_quoted(std::string_view text, std::size_t at, std::size_t least);
[[nodiscard]] ScalarText scan_plain(std::string_view text, std::size_t at, std::size_t least);
[[nodiscard]] ScalarText scan_flow_plain(std::string_view text, std::size_t at, std::size_t least);
/// After | or >.
[[nodiscard]] ScalarText scan_block(std::string_view text, std::size_t at, std::size_t least);

}  // namespace tessera::language
