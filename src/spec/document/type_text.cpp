#include "spec/document/type_text.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::uint64_t largest_capacity = 1U << 20U;
constexpr std::uint64_t largest_extent = 1U << 28U;
constexpr std::size_t longest_unit = 32;

/// Reads a type from left to right.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) { skip_blanks(); }

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::string_view rest() const { return text_.substr(position_); }

  bool take(std::string_view token) {
    if (!rest().starts_with(token)) return false;
    position_ += token.size();
    skip_blanks();
    return true;
  }

  std::string_view take_word() {
    const auto good = [](char c) { return is_identifier(std::string_view(&c, 1)) || (c >= '0' && c <= '9'); };
    const std::string_view left = rest();
    const auto* const end = std::find_if_not(left.begin(), left.end(), good);
    const std::string_view word = left.substr(0, static_cast<std::size_t>(end - left.begin()));
    position_ += word.size();
    skip_blanks();
    return word;
  }

  std::optional<std::uint64_t> take_number() {
    std::uint64_t number = 0;
    const std::string_view left = rest();
    const auto [end, error] = std::from_chars(left.data(), left.data() + left.size(), number);
    if (error != std::errc()) return std::nullopt;
    position_ += static_cast<std::size_t>(end - left.data());
    skip_blanks();
    return number;
  }

 private:
  void skip_blanks() { position_ = std::min(text_.find_first_not_of(" \t\r\n", position_), text_.size()); }

  std::string_view text_;
  std::size_t position_ = 0;
};

/// For brackets behind the name and its length: they are no part of a unit, so that no length gets lost.
std::string bracket_hint(const TypeText& parts, std::string_view unit) {
  const std::size_t open = unit.find_first_of("[]");
  const bool is_length = unit[open] == '[' && Cursor(unit.substr(open + 1)).take_number();
  if (!is_length) return "a unit has no brackets";
  if (parts.extent > 0 && parts.is_sequence)
    return "an array of sequences does not exist: define a structure with the sequence as a field";
  if (parts.extent > 0)
    return "arrays of arrays do not exist: define a structure with the inner array as a field";
  const std::size_t end = unit.find(']', open);
  const std::string length(unit.substr(open, end == std::string_view::npos ? end : end - open + 1));
  std::string_view before = unit.substr(0, open);
  before = before.substr(0, before.find_last_not_of(' ') + 1);
  return "the length comes before the unit: " + parts.name + length + " " + std::string(before);
}

/// For the ways in which ROS writes sequences: `Box[<=16]` and `Box[]`.
std::string sequence_hint(const TypeText& parts, Cursor cursor) {
  const bool bounded = cursor.take("<=");
  const auto most = bounded ? cursor.take_number() : std::nullopt;
  const std::string name =
      parts.name + (parts.capacity ? "<=" + std::to_string(*parts.capacity) : std::string());
  if (most) return "a sequence of at most so many is written " + name + "<=" + std::to_string(*most);
  return "a sequence needs its largest length: " + name + "<=16";
}

}  // namespace

bool is_unit(std::string_view text) {
  constexpr std::string_view signs = "/^*-+.%()' ";
  const bool readable = std::all_of(text.begin(), text.end(), [&](char c) {
    return is_identifier(std::string_view(&c, 1)) || (c >= '0' && c <= '9') ||
           signs.find(c) != std::string_view::npos || static_cast<unsigned char>(c) >= 0x80;
  });
  return readable && text.size() <= longest_unit && text.find("*/") == std::string_view::npos &&
         text.find("/*") == std::string_view::npos;
}

std::optional<TypeText> split_type(const Node& text, Diagnostics& out) {
  Cursor cursor(text.text);
  const auto fail = [&](std::string code, const std::string& message) {
    out.error(std::move(code), text.span, message,
              "types are written float64, float64 m/s, string<=64, Point[8], Point<=8");
    return std::nullopt;
  };
  TypeText parts;
  const std::size_t begin = cursor.position();
  parts.name = cursor.take_word();
  parts.name_span = text.part(begin, std::max<std::size_t>(parts.name.size(), 1));
  if (!is_identifier(parts.name)) return fail("E201", in_quotes(text.text) + " is not a type");
  if (parts.name == "string" && cursor.take("<=")) {
    const auto capacity = cursor.take_number();
    if (!capacity) return fail("E201", "a number must follow '<='");
    if (*capacity == 0 || *capacity > largest_capacity) {
      return fail("E204", "the capacity of a string must lie between 1 and 1048576");
    }
    parts.capacity = static_cast<std::uint32_t>(*capacity);
  }
  parts.is_sequence = cursor.take("<=");
  if (parts.is_sequence || cursor.take("[")) {
    if (!parts.is_sequence && (cursor.rest().starts_with("<=") || cursor.rest().starts_with("]"))) {
      out.error("E201", text.span, in_quotes(text.text) + " is not a type", sequence_hint(parts, cursor));
      return std::nullopt;
    }
    const auto extent = cursor.take_number();
    if (!extent || !(parts.is_sequence || cursor.take("]")))
      return fail("E201",
                  parts.is_sequence ? "a number must follow '<='" : "an array needs its length in brackets");
    if (*extent == 0 || *extent > largest_extent) {
      return fail("E204", "the length of an array must lie between 1 and 268435456");
    }
    parts.extent = *extent;
  }
  std::string_view unit = cursor.rest();
  unit = unit.substr(0, unit.find_last_not_of(" \t\r\n") + 1);
  parts.unit = unit;
  parts.unit_span = text.part(cursor.position(), std::max<std::size_t>(unit.size(), 1));
  if (unit.find_first_of("[]") != std::string_view::npos) {
    out.error("E201", parts.unit_span, in_quotes(unit) + " is not a unit", bracket_hint(parts, unit));
    return std::nullopt;
  }
  if (unit.starts_with("<=")) {
    out.error("E201", parts.unit_span, in_quotes(unit) + " is not a unit",
              "a sequence has one '<=', and a sequence of strings two: string<=64<=8");
    return std::nullopt;
  }
  const bool attached = !unit.empty() && cursor.position() > 0 && text.text[cursor.position() - 1] != ' ' &&
                        text.text[cursor.position() - 1] != ']';
  if (attached || !is_unit(unit)) return fail("E201", in_quotes(unit) + " is not a unit");
  return parts;
}

}  // namespace tessera::spec
