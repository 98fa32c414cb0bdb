#include "spec/conditions/tokens.hpp"

#include <algorithm>
#include <array>

#include "spec/document/text_checks.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

/// The units that std::chrono has literals for.
constexpr std::array duration_units = std::to_array<std::string_view>({"h", "min", "s", "ms", "us", "ns"});

/// Operators of more than one character, longest first.
constexpr std::array long_marks = std::to_array<std::string_view>(
    {"<=>", "->*", "<<=", ">>=", "...", "::", "->", ".*", "<=", ">=", "==", "!=", "&&", "||",
     "<<",  ">>",  "++",  "--",  "+=",  "-=", "*=", "/=", "%=", "&=", "|=", "^=", "=>", "=<"});

bool is_decimal(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) > 127;
}
bool continues_name(char c) { return begins_name(c) || is_decimal(c); }

/// Cuts an expression into tokens.
class Cutter {
 public:
  explicit Cutter(std::string_view text) : text_(text) {}

  std::vector<Token> run() {
    for (skip_blanks(); position_ < text_.size(); skip_blanks()) tokens_.push_back(next());
    tokens_.push_back({Token::Kind::end, {}, text_.size()});
    return std::move(tokens_);
  }

 private:
  void skip_blanks() {
    while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
  }

  [[nodiscard]] char at(std::size_t position) const {
    return position < text_.size() ? text_[position] : '\0';
  }

  Token token(Token::Kind kind, std::size_t end) {
    const Token made{kind, text_.substr(position_, end - position_), position_};
    position_ = end;
    return made;
  }

  [[nodiscard]] std::size_t end_of_name(std::size_t from) const {
    while (continues_name(at(from))) ++from;
    return from;
  }

  Token next() {
    const char c = text_[position_];
    if (is_decimal(c) || (c == '.' && is_decimal(at(position_ + 1)))) return number();
    if (c == '"' || c == '\'') return literal(position_);
    if (begins_name(c)) {
      const std::size_t end = end_of_name(position_);
      return at(end) == '"' || at(end) == '\'' ? literal(end) : token(Token::Kind::name, end);
    }
    for (const std::string_view mark : long_marks)
      if (text_.substr(position_).starts_with(mark)) return token(Token::Kind::mark, position_ + mark.size());
    return token(Token::Kind::mark, position_ + 1);
  }

  /// quote: where its quote stands, behind a prefix such as u8.
  Token literal(std::size_t quote) {
    std::size_t end = quote + 1;
    while (end < text_.size() && text_[end] != text_[quote]) end += text_[end] == '\\' ? 2 : 1;
    return token(Token::Kind::text, std::min(end_of_name(end + 1), text_.size()));
  }

  /// A number of C++ includes its suffix; a unit may follow after blanks.
  Token number() {
    std::size_t end = position_;
    for (char before = '\0';
         continues_name(at(end)) || at(end) == '.' || (at(end) == '\'' && continues_name(at(end + 1))) ||
         ((at(end) == '+' || at(end) == '-') && (before == 'e' || before == 'E') && !is_hexadecimal());
         ++end)
      before = at(end);
    const std::string_view digits = text_.substr(position_, end - position_);
    const std::string_view suffix = suffix_of(digits);
    if (is_duration_unit(suffix)) return token(Token::Kind::duration, end);
    if (read_unit(suffix)) return token(Token::Kind::quantity, with_divisor(suffix, end));
    std::size_t unit = end;
    while (is_blank(at(unit))) ++unit;
    if (unit == end || !begins_name(at(unit)) || !suffix.empty()) return token(Token::Kind::number, end);
    const std::size_t unit_end = end_of_name(unit);
    const std::string_view name = text_.substr(unit, unit_end - unit);
    if (is_duration_unit(name)) return token(Token::Kind::duration, unit_end);
    if (!read_unit(name)) return token(Token::Kind::number, end);
    return token(Token::Kind::quantity, with_divisor(name, unit_end));
  }

  [[nodiscard]] bool is_hexadecimal() const {
    return text_[position_] == '0' && (at(position_ + 1) == 'x' || at(position_ + 1) == 'X');
  }

  /// "m" becomes "m/s", if that is a unit.
  [[nodiscard]] std::size_t with_divisor(std::string_view unit, std::size_t end) const {
    if (at(end) != '/') return end;
    const std::size_t longer = end_of_name(end + 1);
    return read_unit(text_.substr(end - unit.size(), longer - end + unit.size())) ? longer : end;
  }

  /// "ms" of "500ms"; empty: a plain number, or a suffix of C++ is no unit.
  [[nodiscard]] std::string_view suffix_of(std::string_view digits) const {
    if (is_hexadecimal()) return {};
    std::size_t end = digits.size();
    while (end > 0 && begins_name(digits[end - 1])) --end;
    return digits.substr(end);
  }

  std::string_view text_;
  std::size_t position_ = 0;
  std::vector<Token> tokens_;
};

}  // namespace

bool is_duration_unit(std::string_view unit) {
  return std::find(duration_units.begin(), duration_units.end(), unit) != duration_units.end();
}

std::vector<Token> tokens_of(std::string_view expression) { return Cutter(expression).run(); }

std::string with_cpp_durations(std::string expression) {
  std::string result = expression;
  for (const Token& token : tokens_of(expression)) {
    if (token.kind != Token::Kind::duration) continue;
    const std::size_t blank = token.text.find_first_of(" \t\r\n");
    if (blank == std::string_view::npos) continue;
    const std::size_t unit = token.text.find_last_of(" \t\r\n") + 1;
    const std::string joined =
        std::string(token.text.substr(0, blank)) + std::string(token.text.substr(unit));
    std::string gap(token.text.substr(blank, unit - blank));
    result.replace(token.position, token.text.size(), joined + gap);
  }
  return result;
}

}  // namespace tessera::spec
