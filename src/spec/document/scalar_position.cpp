#include "spec/document/scalar_position.hpp"

#include <algorithm>
#include <string_view>

namespace tessera::spec {
namespace {

constexpr std::string_view blank = " \t";

std::uint32_t size32(std::size_t size) { return static_cast<std::uint32_t>(size); }

/// The line at `span` from its column on.
std::string_view rest_of_line(const Span& span, const Diagnostics& source) {
  const std::string_view line = source.line(span.line);
  return span.column - 1 < line.size() ? line.substr(span.column - 1) : std::string_view();
}

std::string_view trim_right(std::string_view text) {
  const std::size_t last = text.find_last_not_of(blank);
  return last == std::string_view::npos ? std::string_view() : text.substr(0, last + 1);
}

/// The position of the quote that ends the text from `start` on, or npos.
std::size_t closing_quote(std::string_view text, std::size_t start, char quote) {
  for (std::size_t i = start; i < text.size(); ++i) {
    const bool doubled = quote == '\'' && text.substr(i, 2) == "''";
    if (doubled || (quote == '"' && text[i] == '\\')) {
      ++i;
    } else if (text[i] == quote) {
      return i;
    }
  }
  return std::string_view::npos;
}

/// A quoted scalar: the span of what is between the quotes, on its first line.
bool locate_quoted(Node& node, const Span& begin, const Diagnostics& source) {
  const std::string_view text = source.text();
  const std::string_view opening = rest_of_line(begin, source);
  const std::size_t start = static_cast<std::size_t>(opening.data() - text.data()) + 1;
  const std::size_t end = closing_quote(text, start, opening.front());
  if (end == std::string_view::npos) return false;
  const std::string_view inside = text.substr(start, end - start);
  const std::string_view first_line = inside.substr(0, inside.find_first_of("\r\n"));
  node.span = {begin.line, begin.column + 1, size32(std::max<std::size_t>(first_line.size(), 1))};
  node.verbatim = inside == node.text;
  return true;
}

/// A block scalar (| or >): the span of its first line that is not blank.
void locate_block(Node& node, const Span& begin, const Diagnostics& source) {
  const std::size_t lines =
      static_cast<std::size_t>(std::count(node.text.begin(), node.text.end(), '\n')) + 1;
  node.span = begin;
  for (std::uint32_t line = begin.line + 1; line <= begin.line + lines + 1; ++line) {
    const std::string_view text = source.line(line);
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) continue;
    node.span = {line, size32(first) + 1, size32(trim_right(text.substr(first)).size())};
    return;
  }
}

void locate_plain(Node& node, const Span& begin, const Diagnostics& source) {
  const std::string_view rest = rest_of_line(begin, source);
  node.verbatim = rest.starts_with(node.text);
  const std::size_t length =
      node.verbatim ? node.text.size() : trim_right(rest.substr(0, rest.find(" #"))).size();
  node.span = {begin.line, begin.column, size32(std::max<std::size_t>(length, 1))};
}

}  // namespace

Span behind_anchor_and_tag(const Span& begin, const Diagnostics& source) {
  Span span = begin;
  for (;;) {
    const std::string_view rest = rest_of_line(span, source);
    if (rest.empty() || (rest.front() != '&' && rest.front() != '!')) return span;
    const std::size_t property_end = rest.find_first_of(blank);
    if (property_end == std::string_view::npos) return begin;
    const std::size_t next = rest.find_first_not_of(blank, property_end);
    if (next == std::string_view::npos || rest[next] == '#') return begin;
    span.column += size32(next);
  }
}

bool locate_scalar(Node& node, const Span& begin, const Diagnostics& source) {
  const Span span = behind_anchor_and_tag(begin, source);
  const std::string_view rest = rest_of_line(span, source);
  const char first = rest.empty() ? ' ' : rest.front();
  if (node.quoted && (first == '"' || first == '\'')) return locate_quoted(node, span, source);
  if (node.quoted && (first == '|' || first == '>')) {
    locate_block(node, span, source);
  } else {
    locate_plain(node, span, source);
  }
  return true;
}

}  // namespace tessera::spec
