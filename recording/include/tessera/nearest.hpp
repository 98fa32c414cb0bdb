#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Suggestions for a misspelled name.
namespace tessera {

/// The candidate that `word` was probably meant to be (small edit distance), or "" if none is near. It
/// considers the first thousand candidates only.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "did you mean 'gripper'?", or "" if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "MESSAGE; HINT", for messages of one line. Without a hint the message alone.
[[nodiscard]] std::string with_hint(std::string message, std::string_view hint);

}  // namespace tessera
