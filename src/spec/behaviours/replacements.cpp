#include "spec/behaviours/replacements.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using diagnostics::Diagnostic;
using diagnostics::in_quotes;

bool is_of_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Whether the word that begins at `at` is a name of its own, or the first one behind in., out., memory. and
/// parameters.
bool stands_alone(std::string_view text, std::size_t at) {
  if (at == 0 || text[at - 1] != '.') return true;
  const std::string_view before = text.substr(0, at - 1);
  for (const std::string_view root : {"in", "out", "memory", "parameters"})
    if (before.ends_with(root)) {
      const std::size_t begin = before.size() - root.size();
      if (begin == 0 || (!is_of_word(before[begin - 1]) && before[begin - 1] != '.')) return true;
    }
  return false;
}

/// The place of `word` in a text, not as a part of a longer word; npos: nowhere.
std::size_t find_word(std::string_view text, std::string_view word) {
  if (word.empty()) return std::string_view::npos;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_of_word(text[at - 1]) || !is_of_word(word.front());
    const bool ends = end == text.size() || !is_of_word(text[end]) || !is_of_word(word.back());
    if (begins && ends) return at;
  }
  return std::string_view::npos;
}

/// The parts of a message in quotes.
std::vector<std::string_view> quoted_in(std::string_view message) {
  std::vector<std::string_view> all;
  for (std::size_t begin = message.find('\''); begin != std::string_view::npos;) {
    const std::size_t end = message.find('\'', begin + 1);
    if (end == std::string_view::npos) break;
    all.push_back(message.substr(begin + 1, end - begin - 1));
    begin = message.find('\'', end + 1);
  }
  return all;
}

/// The same about what a `with` has given. name: of it, in the message.
Diagnostic moved(Diagnostic found, std::string_view name, const Replacement& replacement,
                 const Diagnostics& out) {
  const Given& given = replacement.given;
  found.span = given.at;
  const std::size_t at = find_word(given.text, name);
  if (at != std::string_view::npos && given.verbatim) {
    found.span.column += static_cast<std::uint32_t>(at);
    found.span.length = static_cast<std::uint32_t>(name.size());
  } else {
    found.proposal.reset();
  }
  found.message += " (in place of " + in_quotes(replacement.name) + " in template " +
                   in_quotes(replacement.of_template) + ", " + out.words(replacement.in_template) + ")";
  return found;
}

}  // namespace

std::vector<WordAt> replaceable_words(std::string_view text) {
  std::vector<WordAt> words;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"') quoted = !quoted;
    std::size_t end = at;
    while (end < text.size() && is_of_word(text[end])) ++end;
    if (end > at && !quoted && stands_alone(text, at)) words.push_back({at, text.substr(at, end - at)});
    at = std::max(end, at + 1);
  }
  return words;
}

std::string with_texts(std::string_view text, const TextOf& text_of) {
  std::string made;
  std::size_t done = 0;
  for (const WordAt& word : replaceable_words(text)) {
    const std::string* stands = text_of(std::string(word.text));
    if (stands == nullptr) continue;
    made += text.substr(done, word.begin - done);
    made += *stands;
    done = word.begin + word.text.size();
  }
  return made += text.substr(done);
}

bool is_in(const Replacement& replacement, Span span) {
  const Span& whole = replacement.in_template;
  return whole.line == span.line && span.column >= whole.column && span.column <= whole.column + whole.length;
}

void place(const std::vector<Replacement>& replacements, const Diagnostics& found, Diagnostics& out) {
  for (const Diagnostic& one : found.sorted()) {
    const std::vector<std::string_view> names = quoted_in(one.message);
    bool placed = false;
    for (const Replacement& replacement : replacements) {
      if (!is_in(replacement, one.span)) continue;
      const std::string& text = replacement.given.text;
      const auto name = std::ranges::find_if(names, [&](std::string_view word) {
        return find_word(text, word) != std::string_view::npos ||
               find_word(word, text) != std::string_view::npos;
      });
      if (name == names.end()) continue;
      out.report(moved(one, *name, replacement, out));
      placed = true;
    }
    if (!placed) out.report(one);
  }
}

}  // namespace tessera::spec
