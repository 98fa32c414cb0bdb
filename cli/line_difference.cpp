#include "cli/line_difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "diagnostics/utf8.hpp"

namespace tessera::cli {
namespace {

using TextLines = std::vector<std::string_view>;

constexpr std::size_t most_cells = 4'000'000;

/// With their ends.
TextLines lines_of(std::string_view text) {
  TextLines lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines.push_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

std::string joined(const TextLines& lines, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t at = from; at < to; ++at) text += lines[at];
  return text;
}

}  // namespace

std::string marked(char mark, std::string_view text) {
  std::string marked;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    marked += mark + diagnostics::visible(line) + "\n";
    at = end + 1;
  }
  return marked;
}

std::string line_difference(std::string_view before, std::string_view after) {
  const TextLines old_lines = lines_of(before), new_lines = lines_of(after);
  std::size_t begin = 0, same = 0;
  const std::size_t shorter = std::min(old_lines.size(), new_lines.size());
  while (begin < shorter && old_lines[begin] == new_lines[begin]) ++begin;
  while (same < shorter - begin &&
         old_lines[old_lines.size() - 1 - same] == new_lines[new_lines.size() - 1 - same])
    ++same;
  const std::size_t rows = old_lines.size() - same - begin, columns = new_lines.size() - same - begin;
  // common[r][c]: how many lines the rests from r and c on have in common, in their order
  std::vector<std::vector<std::size_t>> common;
  if (rows * columns <= most_cells) {
    common.assign(rows + 1, std::vector<std::size_t>(columns + 1, 0));
    for (std::size_t row = rows; row-- > 0;)
      for (std::size_t column = columns; column-- > 0;)
        common[row][column] = old_lines[begin + row] == new_lines[begin + column]
                                  ? common[row + 1][column + 1] + 1
                                  : std::max(common[row + 1][column], common[row][column + 1]);
  }
  std::string text;
  std::size_t row = 0, column = 0;
  const auto equal = [&] {
    return !common.empty() && row < rows && column < columns &&
           old_lines[begin + row] == new_lines[begin + column];
  };
  while (row < rows || column < columns) {
    if (equal()) {
      ++row;
      ++column;
      continue;
    }
    const std::size_t first_row = row, first_column = column;
    while ((row < rows || column < columns) && !equal()) {
      const bool goes = common.empty() || column == columns ||
                        (row < rows && common[row + 1][column] >= common[row][column + 1]);
      if (goes && row < rows)
        ++row;
      else
        ++column;
    }
    text += fmt::format("line {}\n", begin + first_row + 1) +
            marked('-', joined(old_lines, begin + first_row, begin + row)) +
            marked('+', joined(new_lines, begin + first_column, begin + column));
  }
  return text;
}

}  // namespace tessera::cli
