#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/document/document.hpp"

/// The words that a `with` has put in the texts of a template, and messages about it.
namespace tessera::spec {

/// The text that stands for a name that a template takes.
struct Given {
  std::string text;
  Span at{};              ///< where a `with` says it
  bool verbatim = false;  ///< it stands there exactly so
};

/// A text of a template in which the text of a `with` has come in place of `name`.
struct Replacement {
  Span in_template;
  std::string name, of_template;
  Given given;
};

/// A word in a text.
struct WordAt {
  std::size_t begin = 0;
  std::string_view text;
};

/// The words of a text that may stand for what a `with` gives.
[[nodiscard]] std::vector<WordAt> replaceable_words(std::string_view text);

/// The text for a word; null: the word stays.
using TextOf = std::function<const std::string*(const std::string& word)>;

/// A text with names of a template replaced, where they stand alone or behind `in.`, `out.`, `memory.` or `parameters.`,
/// but not within quotes.
[[nodiscard]] std::string with_texts(std::string_view text, const TextOf& text_of);

[[nodiscard]] bool is_in(const Replacement& replacement, Span span);

/// Adds what has been found to `out`. A message about a word that a `with` has given is said there, with the
/// line of the template; for each use if several give the same.
void place(const std::vector<Replacement>& replacements, const Diagnostics& found, Diagnostics& out);

}  // namespace tessera::spec
