#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/definitions/type.hpp"

namespace tessera::ros2 {

/// Reads one value of a constant or default. Strings may have quotes; `bare_strings` permits them without.
/// nullopt and `error`: the text is no value of that type, or out of its range.
[[nodiscard]] std::optional<Literal> parse_literal(Primitive primitive, std::string_view text,
                                                   bool bare_strings, std::string& error);
/// "[1, 2, 3]"
[[nodiscard]] std::optional<std::vector<Literal>> parse_literals(Primitive primitive, std::string_view text,
                                                                 std::string& error);

/// The line without its comment; a # within quotes begins no comment.
[[nodiscard]] std::string_view without_comment(std::string_view line);
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace tessera::ros2
