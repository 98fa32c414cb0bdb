#pragma once

#include <chrono>
#include <thread>

#include "eventually.hpp"

namespace tessera::ros2 {

/// Attempts something until `look` sees its effect. A message is lost if it is sent before the other side has found
/// the sender, so it is sent again; each attempt has more time than the one before, since a busy machine is slow.
template <class Attempt, class Look>
[[nodiscard]] bool attempted(Attempt attempt, Look look) {
  std::chrono::milliseconds patience{0};
  return eventually([&] {
    attempt();
    patience += std::chrono::milliseconds(100);
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!look()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  });
}

}  // namespace tessera::ros2
