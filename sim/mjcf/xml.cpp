#include "sim/mjcf/xml.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <system_error>

namespace tessera::sim {

void set_attribute(pugi::xml_node element, const char* name, std::string_view value) {
  pugi::xml_attribute attribute = element.attribute(name);
  if (!attribute) attribute = element.append_attribute(name);
  attribute.set_value(std::string(value).c_str());
}

namespace {

template <class Number>
std::string text_of_numbers(const Number* values, std::size_t count) {
  std::string text;
  std::array<char, 40> digits{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), values[i]).ptr;
    if (i > 0) text += ' ';
    text.append(digits.data(), end);
  }
  return text;
}

}  // namespace

std::string numbers_text(const double* values, std::size_t count) { return text_of_numbers(values, count); }
std::string numbers_text(const float* values, std::size_t count) { return text_of_numbers(values, count); }
std::string numbers_text(const int* values, std::size_t count) { return text_of_numbers(values, count); }

std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r' || *at == '+')) ++at;
    double value = 0;
    const auto read = std::from_chars(at, end, value);
    const bool is_word =
        read.ptr != end && (std::isalpha(static_cast<unsigned char>(*read.ptr)) != 0 || *read.ptr == '_');
    if (read.ec != std::errc() || is_word) return values;  // "infeed" is no infinity
    values.push_back(value);
    at = read.ptr;
  }
}

bool stands_in_body(pugi::xml_node element) {
  const std::string_view parent = element.parent().name();
  return parent == "body" || parent == "worldbody";
}

}  // namespace tessera::sim
