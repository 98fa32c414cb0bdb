#include "language/text/scalars.hpp"

#include <algorithm>

namespace tessera::language {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool is_end_of_line(char c) { return c == '\n' || c == '\r'; }

char byte(std::string_view text, std::size_t at) { return at < text.size() ? text[at] : '\n'; }

std::size_t end_of_line(std::string_view text, std::size_t at) {
  return std::min(text.find_first_of("\r\n", at), text.size());
}

/// The first byte of the line after that of `at`, or the size.
std::size_t next_line(std::string_view text, std::size_t at) {
  at = end_of_line(text, at);
  if (at < text.size() && text[at] == '\r') ++at;
  if (at < text.size() && text[at] == '\n') ++at;
  return at;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return last == std::string_view::npos ? std::string_view() : text.substr(0, last + 1);
}

/// The end of a plain scalar on its line: before ": ", " #", and in brackets before their punctuation.
std::size_t plain_end(std::string_view text, std::size_t at, bool in_flow) {
  const std::size_t line = end_of_line(text, at);
  for (std::size_t i = at; i < line; ++i) {
    if (text[i] == ':' &&
        (is_space(byte(text, i + 1)) ||
         (in_flow && std::string_view(",[]{}").find(byte(text, i + 1)) != std::string_view::npos)))
      return i;
    if (text[i] == '#' && i > at && is_space(text[i - 1])) return i;
    if (in_flow && std::string_view(",[]{}").find(text[i]) != std::string_view::npos) return i;
  }
  return line;
}

/// The end of a quoted text: its closing quote, or npos.
std::size_t quote_end(std::string_view text, std::size_t at, std::size_t limit) {
  const char quote = text[at];
  for (std::size_t i = at + 1; i < limit; ++i) {
    if (quote == '\'' && text[i] == '\'' && byte(text, i + 1) == '\'') {
      ++i;
    } else if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      return i;
    }
  }
  return std::string_view::npos;
}

/// The text between quotes. Escapes that need more than one character stay as written.
std::string unquoted(std::string_view inside, char quote) {
  std::string result;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const char next = i + 1 < inside.size() ? inside[i + 1] : '\0';
    if (quote == '\'' && inside[i] == '\'' && next == '\'') {
      result += '\'';
      ++i;
    } else if (quote == '"' && inside[i] == '\\' && (next == '"' || next == '\\' || next == '/')) {
      result += next;
      ++i;
    } else if (quote == '"' && inside[i] == '\\' && next == 'n') {
      result += '\n';
      ++i;
    } else if (is_end_of_line(inside[i])) {
      result += ' ';
      while (i + 1 < inside.size() && is_space(inside[i + 1])) ++i;
    } else {
      result += inside[i];
    }
  }
  return result;
}

std::size_t indentation(std::string_view text, std::size_t line) {
  std::size_t at = line;
  while (byte(text, at) == ' ' && at < text.size()) ++at;
  return at - line;
}

/// Whether a line can go on with the plain scalar above it: it is indented, and neither key, item nor comment.
bool continues(std::string_view text, std::size_t line, std::size_t least) {
  const std::size_t indent = indentation(text, line);
  const std::size_t at = line + indent;
  if (at >= text.size() || is_end_of_line(text[at]) || indent < least || text[at] == '#') return false;
  if (text[at] == '-' && is_space(byte(text, at + 1))) return false;
  const Key key = scan_key(text, at, false);
  return byte(text, key.after) != ':';
}

ScalarText scan_lines(std::string_view text, std::size_t at, std::size_t least, bool in_flow) {
  ScalarText scalar;
  std::size_t end = plain_end(text, at, in_flow);
  scalar.text = std::string(trimmed(text.substr(at, end - at)));
  scalar.extent = {at, at + scalar.text.size()};
  while (end < text.size() && is_end_of_line(text[end])) {
    const std::size_t line = next_line(text, end);
    if (!continues(text, line, least)) break;
    const std::size_t begin = line + indentation(text, line);
    const std::size_t stop = plain_end(text, begin, in_flow);
    if (stop == begin) break;
    scalar.text += " " + std::string(trimmed(text.substr(begin, stop - begin)));
    end = stop;
    scalar.extent.end = begin + trimmed(text.substr(begin, stop - begin)).size();
  }
  scalar.after = end;
  return scalar;
}

}  // namespace

Key scan_key(std::string_view text, std::size_t at, bool in_flow) {
  Key key;
  const char first = byte(text, at);
  if (at < text.size() && (first == '"' || first == '\'')) {
    const std::size_t end = quote_end(text, at, end_of_line(text, at));
    if (end != std::string_view::npos) {
      key.extent = {at + 1, end};
      key.text = unquoted(text.substr(at + 1, end - at - 1), first);
      key.after = end + 1;
      while (key.after < text.size() && (text[key.after] == ' ' || text[key.after] == '\t')) ++key.after;
      return key;
    }
  }
  const std::size_t end = plain_end(text, at, in_flow);
  key.text = std::string(trimmed(text.substr(at, end - at)));
  key.extent = {at, at + key.text.size()};
  key.after = end;
  return key;
}

ScalarText scan_quoted(std::string_view text, std::size_t at, std::size_t least) {
  ScalarText scalar;
  scalar.quoted = true;
  std::size_t limit = end_of_line(text, at);
  std::size_t end = quote_end(text, at, limit);
  // Over several lines only as far as they are indented: a quote that is still open would take the whole file.
  while (end == std::string_view::npos && limit < text.size()) {
    const std::size_t line = next_line(text, limit);
    const std::size_t stop = end_of_line(text, line);
    const std::size_t indent = indentation(text, line);
    const bool empty = line + indent >= stop;
    if (line <= limit || (!empty && indent < std::max<std::size_t>(least, 1))) break;
    limit = stop;
    if (text.substr(line, stop - line).find(text[at]) != std::string_view::npos)
      end = quote_end(text, at, limit);
    if (end == std::string_view::npos && limit >= text.size()) break;
  }
  if (end == std::string_view::npos) {
    const std::size_t line = end_of_line(text, at);
    scalar.extent = {at + 1, line};
    scalar.text = std::string(text.substr(at + 1, line - std::min(line, at + 1)));
    scalar.after = line;
    return scalar;
  }
  scalar.extent = {at + 1, end};
  scalar.text = unquoted(text.substr(at + 1, end - at - 1), text[at]);
  scalar.after = end + 1;
  return scalar;
}

ScalarText scan_plain(std::string_view text, std::size_t at, std::size_t least) {
  return scan_lines(text, at, least, false);
}

ScalarText scan_flow_plain(std::string_view text, std::size_t at, std::size_t least) {
  return scan_lines(text, at, least, true);
}

ScalarText scan_block(std::string_view text, std::size_t at, std::size_t least) {
  ScalarText scalar;
  scalar.quoted = true;
  const bool folded = text[at] == '>';
  std::size_t end = end_of_line(text, at);
  std::size_t indent = 0;
  scalar.extent = {at, at + 1};
  while (end < text.size()) {
    const std::size_t line = next_line(text, end);
    if (line >= text.size()) break;
    const std::size_t stop = end_of_line(text, line);
    const std::size_t own = indentation(text, line);
    const bool empty = line + own >= stop;
    if (!empty && own < least) break;
    if (!empty) {
      if (indent == 0) {
        indent = own;
        scalar.extent.begin = line + own;
      }
      scalar.text +=
          std::string(text.substr(line + std::min(indent, own), stop - line - std::min(indent, own)));
      scalar.text += folded ? ' ' : '\n';
      scalar.extent.end = stop;
    }
    end = stop;
  }
  scalar.after = end;
  return scalar;
}

}  // namespace tessera::language
