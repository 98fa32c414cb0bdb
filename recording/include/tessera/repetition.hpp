#pragma once

#include <cstdint>

namespace tessera {

/// Whether the n-th event of a kind is told to people, so that many of a kind do not bury the others: the 1st,
/// 10th, 100th and so on.
[[nodiscard]] constexpr bool is_told(std::uint64_t count) {
  while (count > 0 && count % 10 == 0) count /= 10;
  return count == 1;
}

}  // namespace tessera
