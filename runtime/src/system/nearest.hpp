#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// The candidate that was probably meant, by edit distance; empty: none is near.
/// Among equals, the first one.
[[nodiscard]] std::string nearest(std::string_view wanted, std::span<const std::string> candidates);

/// "; did you mean 'X'?", or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view wanted, std::span<const std::string> candidates);

}  // namespace tessera
