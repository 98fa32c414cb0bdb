#include "sim/names.hpp"

#include <algorithm>
#include <numeric>

namespace tessera::sim {
namespace {

/// Levenshtein's edit_distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string unknown_name(std::string_view what, std::string_view name,
                         const std::vector<std::string>& known) {
  std::string text = "no " + std::string(what) + " '" + std::string(name) + "'";
  if (known.empty()) return text + "; there is none at all";
  const auto nearest =
      std::ranges::min_element(known, {}, [&](const std::string& k) { return edit_distance(name, k); });
  if (edit_distance(name, *nearest) <= name.size() / 3 + 1) text += " (did you mean '" + *nearest + "'?)";
  text += known.size() == 1 ? "; there is " : "; there are ";
  for (const std::string& k : known) text += k + ", ";
  text.resize(text.size() - 2);
  return text;
}

}  // namespace tessera::sim
