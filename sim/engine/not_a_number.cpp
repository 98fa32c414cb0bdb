#include "sim/engine/not_a_number.hpp"

#include <algorithm>
#include <cctype>

namespace tessera::sim {
namespace {

/// `attribute` of a value that begins behind the quotation mark at `quote`; empty: it is none.
std::string_view attribute_before(std::string_view xml, std::size_t quote) {
  const auto last = [&](std::size_t before, std::string_view characters) {
    return before == 0 ? std::string_view::npos : xml.find_last_not_of(characters, before - 1);
  };
  const std::size_t equals = last(quote, " \t\r\n");
  if (equals == std::string_view::npos || xml[equals] != '=') return {};
  const std::size_t end = last(equals, " \t\r\n");
  if (end == std::string_view::npos) return {};
  const std::size_t before = xml.find_last_of(" \t\r\n<>\"'", end);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  return xml.substr(begin, end + 1 - begin);
}

bool is_nan_at(std::string_view xml, std::size_t at) {
  const auto is_letter = [&](std::size_t index, char letter) {
    return std::tolower(static_cast<unsigned char>(xml[index])) == letter;
  };
  return is_letter(at, 'n') && is_letter(at + 1, 'a') && is_letter(at + 2, 'n');
}

}  // namespace

std::optional<std::string> not_a_number_in(std::string_view xml) {
  constexpr std::string_view of_numbers = "0123456789+-.eEnNaA \t\r\n";
  for (std::size_t at = 0; at + 3 <= xml.size(); ++at) {
    if (!is_nan_at(xml, at)) continue;
    const std::size_t quote = xml.find_last_not_of(of_numbers, at);
    const std::size_t end = xml.find_first_not_of(of_numbers, at);
    if (quote == std::string_view::npos || end == std::string_view::npos) continue;
    if ((xml[quote] != '"' && xml[quote] != '\'') || xml[end] != xml[quote]) continue;
    const std::string_view attribute = attribute_before(xml, quote);
    if (attribute.empty() || attribute == "name") continue;
    const auto line = 1 + std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    return "`" + std::string(attribute) + "` is NaN (line " + std::to_string(line) + ")";
  }
  return std::nullopt;
}

}  // namespace tessera::sim
