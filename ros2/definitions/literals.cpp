#include "ros2/definitions/literals.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tessera::ros2 {
namespace {

/// Decimal, 0x.., 0b.. or 0o..; `negative` was read before.
std::optional<std::uint64_t> natural(std::string_view text) {
  int base = 10;
  if (text.size() > 2 && text[0] == '0') {
    const char mark = text[1];
    base = mark == 'x' || mark == 'X'   ? 16
           : mark == 'b' || mark == 'B' ? 2
           : mark == 'o' || mark == 'O' ? 8
                                        : 10;
    if (base != 10) text.remove_prefix(2);
  }
  std::uint64_t number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<Literal> integer_literal(Primitive primitive, std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const std::optional<std::uint64_t> magnitude = natural(text);
  if (!magnitude) return std::nullopt;
  const std::size_t bits = 8 * size_of(primitive);
  const bool is_signed = primitive == Primitive::int8 || primitive == Primitive::int16 ||
                         primitive == Primitive::int32 || primitive == Primitive::int64;
  const std::uint64_t highest =
      std::numeric_limits<std::uint64_t>::max() >> (64 - bits + (is_signed ? 1 : 0));
  if (*magnitude > highest + (is_signed && negative ? 1 : 0)) return std::nullopt;
  if (!is_signed) return negative && *magnitude > 0 ? std::nullopt : std::optional<Literal>(*magnitude);
  // The lowest number has no positive counterpart.
  return negative ? static_cast<std::int64_t>(~*magnitude + 1) : static_cast<std::int64_t>(*magnitude);
}

std::optional<Literal> real_literal(Primitive primitive, std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (primitive == Primitive::float32 && std::isfinite(number) &&
      std::abs(number) > static_cast<double>(std::numeric_limits<float>::max()))
    return std::nullopt;
  return number;
}

std::optional<Literal> boolean_literal(std::string_view text) {
  if (text == "true" || text == "True" || text == "1") return true;
  if (text == "false" || text == "False" || text == "0") return false;
  return std::nullopt;
}

/// The text within quotes, with \" and the like resolved.
std::optional<Literal> text_literal(std::string_view text, bool bare) {
  const bool quoted = !text.empty() && (text[0] == '"' || text[0] == '\'');
  if (!quoted) return bare ? std::optional<Literal>(std::string(text)) : std::nullopt;
  std::string found;
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (text[at] == text[0])
      return at + 1 == text.size() ? std::optional<Literal>(std::move(found)) : std::nullopt;
    if (text[at] == '\\' && at + 1 < text.size()) {
      ++at;
      found += text[at] == 'n' ? '\n' : text[at] == 't' ? '\t' : text[at];
    } else {
      found += text[at];
    }
  }
  return std::nullopt;  // no closing quote
}

std::optional<Literal> literal_of(Primitive primitive, std::string_view text, bool bare) {
  switch (primitive) {
    case Primitive::boolean:
      return boolean_literal(text);
    case Primitive::float32:
    case Primitive::float64:
      return real_literal(primitive, text);
    case Primitive::string:
    case Primitive::wstring:
      return text_literal(text, bare);
    case Primitive::structure:
      return std::nullopt;
    default:
      return integer_literal(primitive, text);
  }
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\f\v";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string_view without_comment(std::string_view line) {
  char quote = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (quote != 0 && line[at] == '\\') {
      ++at;
    } else if (quote != 0) {
      if (line[at] == quote) quote = 0;
    } else if (line[at] == '#') {
      return line.substr(0, at);
    } else if ((line[at] == '"' || line[at] == '\'') && at > 0 &&
               std::string_view(" \t=[,").find(line[at - 1]) != std::string_view::npos) {
      quote = line[at];
    }
  }
  // A quote without an end counts as an apostrophe in a comment, if there is a comment.
  return quote == 0 ? line : line.substr(0, line.find('#'));
}

std::optional<Literal> parse_literal(Primitive primitive, std::string_view text, bool bare_strings,
                                     std::string& error) {
  std::optional<Literal> found = literal_of(primitive, text, bare_strings);
  if (!found) error = "'" + std::string(text) + "' is no value of the type " + name_of(primitive);
  return found;
}

std::optional<std::vector<Literal>> parse_literals(Primitive primitive, std::string_view text,
                                                   std::string& error) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') {
    error = "the default of an array is a list in brackets, not '" + std::string(text) + "'";
    return std::nullopt;
  }
  text = trimmed(text.substr(1, text.size() - 2));
  std::vector<Literal> all;
  char quote = 0;
  std::size_t first = 0;
  for (std::size_t at = 0; !text.empty() && at <= text.size(); ++at) {
    const bool end = at == text.size();
    if (!end && quote != 0 && text[at] == '\\') {
      ++at;
      continue;
    }
    if (!end && (text[at] == '"' || text[at] == '\''))
      quote = quote == 0 ? text[at] : quote == text[at] ? '\0' : quote;
    if (!end && (quote != 0 || text[at] != ',')) continue;
    const auto one = parse_literal(primitive, trimmed(text.substr(first, at - first)), false, error);
    if (!one) return std::nullopt;
    all.push_back(*one);
    first = at + 1;
  }
  return all;
}

}  // namespace tessera::ros2
