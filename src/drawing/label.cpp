#include "drawing/label.hpp"

#include <algorithm>

namespace tessera::drawing {

Label::Label(std::string text) {
  if (!text.empty()) runs.push_back({std::move(text)});
}

Label& Label::add(std::string text, Level level, bool italic) {
  if (text.empty()) return *this;
  if (!runs.empty() && runs.back().level == level && runs.back().italic == italic)
    runs.back().text += text;
  else
    runs.push_back({std::move(text), level, italic});
  return *this;
}

Label& Label::add(const Label& other) {
  for (const Run& run : other.runs) add(run.text, run.level, run.italic);
  return *this;
}

std::string Label::plain() const {
  std::string text;
  for (const Run& run : runs) text += run.text;
  return text;
}

double width_of(std::string_view text, double font_size) {
  double em = 0;
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if ((byte & 0xC0U) == 0x80U) continue;  // counts with the first byte of its character
    if (std::string_view("iljtfrI.,:;|'![]()-").find(character) != std::string_view::npos)
      em += 0.40;
    else if (std::string_view("mwMW@").find(character) != std::string_view::npos)
      em += 0.95;
    else
      em += byte >= 0x80 || (character >= 'A' && character <= 'Z') ? 0.72 : 0.63;
  }
  return em * font_size;
}

double width_of(const Label& label, double font_size) {
  double width = 0;
  for (const Label::Run& run : label.runs)
    width += width_of(run.text, run.level == Label::Level::base ? font_size : font_size * script_scale);
  return width;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t lines) {
  std::vector<std::string> result;
  std::string_view rest = text;
  while (!rest.empty()) {
    if (rest.size() <= width) {
      result.emplace_back(rest);
      break;
    }
    std::size_t cut = rest.rfind(' ', width);
    if (cut == std::string_view::npos || cut == 0) cut = width;
    while (cut < rest.size() && (static_cast<unsigned char>(rest[cut]) & 0xC0U) == 0x80U) ++cut;
    result.emplace_back(rest.substr(0, cut));
    rest.remove_prefix(cut);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    if (result.size() == lines && !rest.empty()) {
      result.back() += "\u2026";
      break;
    }
  }
  return result;
}

}  // namespace tessera::drawing
