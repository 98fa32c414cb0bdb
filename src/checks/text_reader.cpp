#include "checks/text_reader.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace tessera::checks {
namespace {

constexpr std::int64_t largest_index = 1'000'000;
constexpr const char* index_hint = "an index is a number, i, i+1, i-1 or *";

bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r'; }

}  // namespace

bool TextReader::is_digit(char letter) { return letter >= '0' && letter <= '9'; }
bool TextReader::is_letter(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
}

std::string_view TextReader::rest() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  return text_.substr(at_);
}
std::string_view TextReader::word() {
  const std::string_view left = rest();
  const auto end = std::ranges::find_if_not(
      left, [](char letter) { return is_letter(letter) || is_digit(letter) || letter == '_'; });
  return left.substr(0, static_cast<std::size_t>(end - left.begin()));
}
bool TextReader::take(std::string_view symbol) {
  if (!rest().starts_with(symbol)) return false;
  at_ += symbol.size();
  return true;
}
bool TextReader::take_word(std::string_view wanted) {
  if (word() != wanted) return false;
  at_ += wanted.size();
  return true;
}

void TextReader::fail(Place place, std::string text, Hint hint) {
  place.length = std::max<std::size_t>(place.length, 1);
  if (!mistake_) mistake_ = {place, std::move(text), std::move(hint)};
  at_ = text_.size();
}
std::string TextReader::name_part() {
  const std::size_t from = at_;
  while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) ||
                                std::string_view("_-.").find(text_[at_]) != std::string_view::npos))
    ++at_;
  if (at_ == from) fail({from, 1}, "a name should stand here", element_hint);
  return std::string(text_.substr(from, at_ - from));
}

Element TextReader::element() {
  static_cast<void>(rest());
  Element found;
  const std::size_t from = at_;
  if (at_ < text_.size() && text_[at_] == '/') {  // of the world itself
    ++at_;
    found.name = "/";
  }
  found.name += name_part();
  read_index(found);
  std::string& after = found.index == Element::Index::none ? found.name : found.rest;
  while (at_ < text_.size() && text_[at_] == '/') {
    ++at_;
    after += "/" + name_part();
  }
  found.place = since(from);
  return found;
}

void TextReader::read_index(Element& element) {
  if (at_ >= text_.size() || text_[at_] != '[') return;
  const std::size_t from = at_;
  ++at_;
  if (take("*")) {
    element.index = Element::Index::every;
  } else if (take("i")) {
    element.index = Element::Index::running;
    if (take("+"))
      element.number = index_number(from);
    else if (take("-"))
      element.number = -index_number(from);
  } else {
    element.index = Element::Index::constant;
    element.number = index_number(from);
  }
  if (!take("]")) fail(since(from), "this is no index", index_hint);
}
std::int64_t TextReader::index_number(std::size_t from) {
  const std::string_view digits = word();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size() ||
      number > largest_index)
    fail({from, at_ + digits.size() - from}, "this is no index", index_hint);
  else
    at_ += digits.size();
  return number;
}

}  // namespace tessera::checks
