#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Suggestions for a misspelled name.
namespace tessera {

/// The candidate that `word` was probably meant to be (small edit distance), or "" if none is near. It
/// considers the first thousand candidates only.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Advice about a mistake.
struct Hint {
  Hint() = default;
  Hint(std::string words) : text(std::move(words)) {}
  Hint(const char* words) : text(words) {}
  [[nodiscard]] bool empty() const { return text.empty(); }

  std::string text;                     ///< for people; may be empty
  std::optional<std::string> proposal;  ///< the name that the text proposes instead of the wrong one
};

/// "did you mean 'gripper'?"
[[nodiscard]] Hint proposing(std::string name);
/// The same for the nearest candidate; empty if none is near.
[[nodiscard]] Hint did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "MESSAGE; HINT", for messages of one line. Without a hint the message alone.
[[nodiscard]] std::string with_hint(std::string message, const Hint& hint);

}  // namespace tessera
