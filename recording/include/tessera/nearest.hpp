#pragma once

#include <string>
#include <string_view>
#include <vector>

/// What somebody probably meant who wrote a name that does not exist.
namespace tessera {

/// The candidate that `word` was probably meant to be (small edit distance), or "" if none is near.
/// Of very many candidates only the first thousand are looked at.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "did you mean 'gripper'?", or "" if nothing is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "MESSAGE; HINT", for messages of one line. Without a hint the message alone.
[[nodiscard]] std::string with_hint(std::string message, std::string_view hint);

}  // namespace tessera
