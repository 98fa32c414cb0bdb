#include "tessera/nearest.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace tessera {
namespace {

constexpr std::size_t longest_word = 80;
constexpr std::size_t most_candidates = 1000;  // a hint is not worth more time than that

std::string lower(std::string_view word) {
  std::string result(word);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// Insertions, deletions, replacements and swaps of neighbours (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

/// One bit per character, in lower case. A character that occurs in only one of two
/// words counts as a mistake.
std::uint64_t characters(std::string_view word) {
  std::uint64_t bits = 0;
  for (const char c : word) bits |= std::uint64_t{1} << (static_cast<unsigned char>(c) & 31U);
  return bits;
}

/// How many mistakes a word of this length may contain and still be recognised.
std::size_t tolerance(std::size_t length) { return length <= 2 ? 1 : (length + 2) / 3; }

/// The only candidate that begins with `word` (in lower case), or "".
std::string abbreviated(const std::string& word, std::span<const std::string> candidates) {
  constexpr std::size_t shortest = 3;
  std::string found;
  for (const std::string& candidate : candidates) {
    const bool longer = word.size() >= shortest && candidate.size() > word.size();
    if (!longer || !lower(candidate.substr(0, word.size())).starts_with(word)) continue;
    if (!found.empty()) return {};
    found = candidate;
  }
  return found;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.empty() || word.size() > longest_word) return {};
  const std::string wanted = lower(word);
  // The first number ignores case, so a difference only in case hardly counts.
  const std::uint64_t wanted_characters = characters(word);
  std::pair best{std::numeric_limits<std::size_t>::max(), std::size_t{0}};
  const std::string* found = nullptr;
  const std::span<const std::string> tried(candidates.data(), std::min(candidates.size(), most_candidates));
  for (const std::string& candidate : tried) {
    const std::size_t limit = tolerance(std::min(word.size(), candidate.size()));
    const std::size_t gap = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (candidate.empty() || candidate == word || gap > limit) continue;
    const auto foreign = static_cast<std::size_t>(std::popcount(wanted_characters & ~characters(candidate)));
    if (foreign > limit) continue;
    const std::size_t distance = edit_distance(wanted, lower(candidate));
    const bool all_replaced = distance >= std::max(word.size(), candidate.size());
    const std::pair score{distance, edit_distance(word, candidate)};
    if (distance > limit || all_replaced || score >= best) continue;
    best = score;
    found = &candidate;
  }
  return found == nullptr ? abbreviated(wanted, tried) : *found;
}

Hint proposing(std::string name) {
  Hint hint("did you mean '" + name + "'?");
  hint.proposal = std::move(name);
  return hint;
}

Hint did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  std::string found = nearest(word, candidates);
  return found.empty() ? Hint() : proposing(std::move(found));
}

std::string with_hint(std::string message, const Hint& hint) {
  if (!hint.empty()) message.append("; ").append(hint.text);
  return message;
}

}  // namespace tessera
