#include "language/names/code.hpp"

#include <algorithm>
#include <string>

namespace tessera::language {
namespace {

bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Cuts a source into tokens.
class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  std::vector<Token> scan() {
    while (at_ < source_.size()) step();
    return std::move(tokens_);
  }

 private:
  [[nodiscard]] char peek(std::size_t ahead) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
  }

  void add(Token::Kind kind, std::size_t begin, std::size_t end) {
    at_ = std::min(end, source_.size());
    tokens_.push_back({kind, {begin, at_}, source_.substr(begin, at_ - begin)});
  }

  void step() {
    const char c = source_[at_];
    if (c == '\n') {
      line_begins_ = true;
      ++at_;
    } else if (c == ' ' || c == '\t' || c == '\r') {
      ++at_;
    } else if (c == '#' && line_begins_) {
      skip_directive();
    } else {
      line_begins_ = false;
      token(c);
    }
  }

  void token(char c) {
    if (c == '/' && peek(1) == '/') {
      at_ = std::min(source_.find('\n', at_), source_.size());
    } else if (c == '/' && peek(1) == '*') {
      const std::size_t end = source_.find("*/", at_ + 2);
      at_ = end == std::string_view::npos ? source_.size() : end + 2;
    } else if (c == '"' || c == '\'') {
      quoted(c);
    } else if (c == 'R' && peek(1) == '"') {
      raw();
    } else if (starts_name(c)) {
      std::size_t end = at_ + 1;
      while (end < source_.size() && (starts_name(source_[end]) || is_digit(source_[end]))) ++end;
      add(Token::Kind::name, at_, end);
    } else if (is_digit(c)) {
      number();
    } else if ((c == '-' && peek(1) == '>') || (c == ':' && peek(1) == ':')) {
      add(Token::Kind::sign, at_, at_ + 2);
    } else {
      add(Token::Kind::sign, at_, at_ + 1);
    }
  }

  void skip_directive() {
    while (at_ < source_.size() && source_[at_] != '\n') at_ += source_[at_] == '\\' ? 2 : 1;
  }

  void quoted(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote && source_[end] != '\n')
      end += source_[end] == '\\' ? 2 : 1;
    add(Token::Kind::literal, at_, end + 1);
  }

  void raw() {
    const std::size_t open = source_.find('(', at_);
    if (open == std::string_view::npos || open - at_ > 20) return add(Token::Kind::name, at_, at_ + 1);
    const std::string close = ")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"";
    const std::size_t end = source_.find(close, open);
    add(Token::Kind::literal, at_, end == std::string_view::npos ? source_.size() : end + close.size());
  }

  /// With digit separators, exponents and suffixes: 1'000, 0x1F, 2.5e-3, 10ms.
  void number() {
    std::size_t end = at_ + 1;
    while (end < source_.size()) {
      const char c = source_[end];
      const char before = source_[end - 1];
      const bool exponent = (c == '+' || c == '-') && (before == 'e' || before == 'E');
      const bool separator = c == '\'' && end + 1 < source_.size() && is_digit(source_[end + 1]);
      if (!is_digit(c) && !starts_name(c) && c != '.' && !exponent && !separator) break;
      ++end;
    }
    add(Token::Kind::literal, at_, end);
  }

  std::string_view source_;
  std::size_t at_ = 0;
  bool line_begins_ = true;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokens_of(std::string_view source) { return Scanner(source).scan(); }

std::vector<DottedPath> paths_in(std::string_view text) {
  const std::vector<Token> tokens = tokens_of(text);
  std::vector<DottedPath> all;
  const auto is = [&](std::size_t at, std::string_view sign) {
    return at < tokens.size() && tokens[at].text == sign;
  };
  bool arrow = false;
  for (std::size_t at = 0; at < tokens.size();) {
    if (tokens[at].kind != Token::Kind::name) {
      arrow = is(at, "->");
      ++at;
      continue;
    }
    DottedPath path;
    path.after_arrow = arrow;
    path.extent.begin = tokens[at].extent.begin;
    for (;;) {
      path.words.push_back({tokens[at].text, tokens[at].extent});
      path.extent.end = tokens[at].extent.end;
      ++at;
      if (is(at, "[")) {
        while (at < tokens.size() && !is(at, "]")) ++at;
        if (at < tokens.size()) path.extent.end = tokens[at++].extent.end;
      }
      if (!is(at, ".") || at + 1 >= tokens.size() || tokens[at + 1].kind != Token::Kind::name) break;
      ++at;
    }
    path.before_arrow = is(at, "->");
    arrow = false;
    all.push_back(std::move(path));
  }
  return all;
}

std::vector<Extent> objects_in(std::string_view text, bool only_marked) {
  const auto is_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const auto one_of = [&](std::string_view all, std::size_t at) {
    return at < text.size() && all.find(text[at]) != std::string_view::npos;
  };
  std::vector<Extent> all;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_word(text[at])) {
      ++at;
      continue;
    }
    const std::size_t begin = at;
    while (at < text.size() && is_word(text[at])) ++at;
    const bool number = one_of("0123456789", begin);
    const bool part = begin > 0 && one_of("./", begin - 1);
    // The word behind a number is its unit.
    const std::size_t before = begin == 0 ? std::string_view::npos : text.find_last_not_of(" \t", begin - 1);
    const bool unit = before != std::string_view::npos && before + 1 < begin && one_of("0123456789", before);
    std::size_t end = at;
    if (one_of("[", at)) end = std::min(text.find(']', at), text.size() - 1) + 1;
    const bool is_object = only_marked ? end > at || one_of("/", at) : !unit && !one_of(".([", end);
    if (!number && !part && is_object) all.push_back({begin, at});
  }
  return all;
}

}  // namespace tessera::language
