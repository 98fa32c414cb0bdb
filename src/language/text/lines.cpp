#include "language/text/lines.hpp"

#include <algorithm>

#include "diagnostics/utf8.hpp"

namespace tessera::language {
namespace {

std::uint32_t units_of(const diagnostics::CodePoint& point) { return point.code > 0xFFFF ? 2 : 1; }

}  // namespace

Lines::Lines(std::string_view text) : text_(text), starts_{0} {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\r' && at + 1 < text.size() && text[at + 1] == '\n') continue;
    if (text[at] == '\n' || text[at] == '\r') starts_.push_back(at + 1);
  }
}

std::size_t Lines::start_of(std::size_t line) const {
  return line < starts_.size() ? starts_[line] : text_.size();
}

std::string_view Lines::line(std::size_t number) const {
  if (number >= starts_.size()) return {};
  std::string_view whole = text_.substr(starts_[number], start_of(number + 1) - starts_[number]);
  while (!whole.empty() && (whole.back() == '\n' || whole.back() == '\r')) whole.remove_suffix(1);
  return whole;
}

std::size_t Lines::offset(Position position) const {
  if (position.line >= starts_.size()) return text_.size();
  const std::string_view line = this->line(position.line);
  std::size_t at = 0;
  for (std::uint32_t units = 0; at < line.size() && units < position.character;) {
    const diagnostics::CodePoint point = diagnostics::decode(line, at);
    units += units_of(point);
    at += point.length;
  }
  return starts_[position.line] + at;
}

Position Lines::position(std::size_t offset) const {
  offset = std::min(offset, text_.size());
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto number = static_cast<std::size_t>(after - starts_.begin()) - 1;
  const std::string_view line = this->line(number);
  const std::size_t end = std::min(offset - starts_[number], line.size());
  std::uint32_t units = 0;
  for (std::size_t at = 0; at < end;) {
    const diagnostics::CodePoint point = diagnostics::decode(line, at);
    units += units_of(point);
    at += point.length;
  }
  return {static_cast<std::uint32_t>(number), units};
}

void replace(std::string& text, Range range, std::string_view with) {
  const Lines lines(text);
  const std::size_t begin = lines.offset(range.start);
  const std::size_t end = std::max(begin, lines.offset(range.end));
  text.replace(begin, end - begin, with);
}

}  // namespace tessera::language
