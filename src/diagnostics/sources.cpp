#include "diagnostics/sources.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tessera::diagnostics {

void Sources::add(std::string given, std::string file, std::uint32_t before) {
  given_ = std::move(given);
  included_.push_back({std::move(file), before});
}

SourceLine Sources::at(std::uint32_t number) const {
  const auto behind = std::ranges::lower_bound(included_, number, {}, &Included::before);
  if (behind == included_.begin()) return {{}, number};
  const Included& file = *std::prev(behind);
  return {file.file, number - file.before};
}

std::string Sources::words(std::uint32_t number) const {
  const SourceLine place = at(number);
  std::string text = "line " + std::to_string(place.line);
  if (!included_.empty()) text += " of " + (place.file.empty() ? given_ : std::string(place.file));
  return text;
}

std::uint32_t Sources::own_line(std::uint32_t number) const { return at(number).file.empty() ? number : 0; }

std::string Sources::included_line(std::uint32_t number) const {
  const SourceLine place = at(number);
  return place.file.empty() ? std::string() : std::string(place.file) + ":" + std::to_string(place.line);
}

std::string Sources::short_words(std::uint32_t number) const {
  const std::string included = included_line(number);
  return included.empty() ? "line " + std::to_string(number) : included;
}

std::vector<std::string> Sources::included() const {
  std::vector<std::string> names;
  for (const Included& one : included_) names.push_back(one.file);
  return names;
}

}  // namespace tessera::diagnostics
