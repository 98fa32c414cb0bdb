#include "spec/document/expression_text.hpp"

#include <optional>
#include <string_view>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

/// A mistake and its position in the text.
struct Mistake {
  std::size_t position = 0;
  std::string message;
};

/// Walks over a C++ expression, minding literals and brackets.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  std::optional<Mistake> run() {
    while (position_ < text_.size() && !mistake_) step();
    if (!mistake_ && !open_.empty())
      fail(open_.back(), std::string("'") + text_[open_.back()] + "' is not closed");
    return mistake_;
  }

 private:
  void fail(std::size_t position, std::string message) { mistake_ = Mistake{position, std::move(message)}; }

  void step() {
    const char c = text_[position_];
    const std::string_view two = text_.substr(position_, 2);
    if (c == '"' || (c == '\'' && !separates_digits())) {
      skip_literal(c);
    } else if (c == '(' || c == '[' || c == '{') {
      open_.push_back(position_++);
    } else if (c == ')' || c == ']' || c == '}') {
      close(c);
    } else if (two == "//" || two == "/*") {
      fail(position_, "a comment does not belong in an expression");
    } else if (c == ';' || c == '#' || c == '\\') {
      fail(position_, std::string("'") + c + "' does not belong in an expression");
    } else {
      ++position_;
    }
  }

  /// 1'000'000
  [[nodiscard]] bool separates_digits() const {
    const auto is_digit = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    };
    return position_ > 0 && position_ + 1 < text_.size() && is_digit(text_[position_ - 1]) &&
           is_digit(text_[position_ + 1]);
  }

  void skip_literal(char quote) {
    const std::size_t start = position_++;
    while (position_ < text_.size() && text_[position_] != quote && text_[position_] != '\n') {
      position_ += text_[position_] == '\\' ? 2 : 1;
    }
    if (position_ >= text_.size() || text_[position_] != quote)
      fail(start, "a quote that opens here is not closed");
    ++position_;
  }

  void close(char c) {
    const char wanted = c == ')' ? '(' : c == ']' ? '[' : '{';
    if (open_.empty() || text_[open_.back()] != wanted) {
      fail(position_, std::string("'") + c + "' closes nothing");
      return;
    }
    open_.pop_back();
    ++position_;
  }

  std::string_view text_;
  std::size_t position_ = 0;
  std::vector<std::size_t> open_;
  std::optional<Mistake> mistake_;
};

}  // namespace

std::string expression_text(const Node& text, Diagnostics& out) {
  if (const auto mistake = Walk(text.text).run()) {
    out.error("E209", text.part(mistake->position, 1), mistake->message, "write one expression of C++");
  }
  const std::size_t first = text.text.find_first_not_of(" \t\r\n");
  return text.text.substr(first, text.text.find_last_not_of(" \t\r\n") - first + 1);
}

}  // namespace tessera::spec
