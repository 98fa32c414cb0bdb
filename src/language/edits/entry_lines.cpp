#include "language/edits/entry_lines.hpp"

#include <algorithm>

namespace tessera::language {

std::size_t start_of_line(const std::string& text, std::size_t at) {
  const std::size_t end = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return end == std::string::npos ? 0 : end + 1;
}

std::size_t end_of_line(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

Extent lines_of(const TextEditor& editor, const Entry& entry) {
  const std::string& text = editor.text();
  const std::size_t column = editor.column_of(entry.whole.begin);
  Extent lines{start_of_line(text, entry.whole.begin), end_of_line(text, entry.whole.end)};
  while (lines.begin > 0) {
    const std::size_t above = start_of_line(text, lines.begin - 1);
    const std::size_t first = text.find_first_not_of(' ', above);
    if (first != above + column || text[first] != '#') break;
    lines.begin = above;
  }
  return lines;
}

std::string moved_to_column(std::string_view lines, std::size_t from, std::size_t to) {
  std::string all;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size() - 1) + 1;
    std::string_view line = lines.substr(at, end - at);
    const bool is_empty = line.find_first_not_of(" \t\r\n") == std::string_view::npos;
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    if (!is_empty) {
      line.remove_prefix(std::min(indent, from));
      all += std::string(to, ' ');
    }
    all += line;
    at = end;
  }
  return all;
}

}  // namespace tessera::language
