#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "language/edits/text_editor.hpp"

/// The whole lines that an entry of a map takes in a text.
namespace tessera::language {

[[nodiscard]] std::size_t start_of_line(const std::string& text, std::size_t at);

/// Behind the line break of the line that `at` is in.
[[nodiscard]] std::size_t end_of_line(const std::string& text, std::size_t at);

/// The lines of an entry with the comments of the same column above it.
[[nodiscard]] Extent lines_of(const TextEditor& editor, const Entry& entry);

/// The same lines in another column.
[[nodiscard]] std::string moved_to_column(std::string_view lines, std::size_t from, std::size_t to);

}  // namespace tessera::language
