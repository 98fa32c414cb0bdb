#include "spec/conditions/positions.hpp"

#include <algorithm>

#include "spec/document/text_checks.hpp"

namespace tessera::spec {

Positions::Positions(const Node& text, const Diagnostics& source) : text_(text) {
  if (!text.verbatim && !align(source)) bytes_.clear();
}

bool Positions::align(const Diagnostics& source) {
  std::uint32_t line = text_.span.line;
  std::size_t column = text_.span.column - 1;  // from 0
  std::string_view in_file = source.line(line);
  const auto lines = static_cast<std::uint32_t>(text_.text.size()) + 2;  // more cannot belong to it
  for (const char c : text_.text) {
    if (is_blank(c)) {
      bytes_.push_back({line, static_cast<std::uint32_t>(column) + 1, 1});
      continue;
    }
    for (bool skips = true; skips;) {
      while (column >= in_file.size() && line < text_.span.line + lines) {
        in_file = source.line(++line);
        column = 0;
      }
      if (column >= in_file.size()) return false;
      const char there = in_file[column];
      // A backslash of "...", or the first quote of '...'.
      const bool escapes = there != c && (there == '\\' || there == '\'') && column + 1 < in_file.size();
      const bool doubled =
          there == '\'' && c == '\'' && in_file.substr(column).starts_with("''") && text_.quoted;
      skips = is_blank(there) || escapes || doubled;
      if (skips) ++column;
      if (doubled) break;
    }
    if (in_file[column] != c) return false;
    bytes_.push_back({line, static_cast<std::uint32_t>(column) + 1, 1});
    ++column;
  }
  return true;
}

Span Positions::part(std::size_t offset, std::size_t length) const {
  if (text_.verbatim) return text_.part(offset, std::max<std::size_t>(length, 1));
  if (offset >= bytes_.size()) return text_.span;
  const Span begin = bytes_[offset];
  const std::size_t last = std::min(offset + std::max<std::size_t>(length, 1), bytes_.size()) - 1;
  std::size_t end = last;
  while (end > offset && bytes_[end].line != begin.line) --end;
  return {begin.line, begin.column, std::max(bytes_[end].column, begin.column) - begin.column + 1};
}

}  // namespace tessera::spec
