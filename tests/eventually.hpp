#pragma once

#include <chrono>
#include <thread>

namespace tessera {

/// How long a test waits for what must come: far longer than it takes on a busy machine, but not for ever.
inline constexpr std::chrono::seconds test_patience{120};

/// Looks until `look` holds. false: it did not within `test_patience`, or `hopeless` held first.
///
/// It sleeps a little between two looks, since what it waits for needs the machine too.
template <class Look, class Hopeless>
[[nodiscard]] bool eventually(Look look, Hopeless hopeless) {
  const auto end = std::chrono::steady_clock::now() + test_patience;
  while (!look()) {
    if (hopeless() || std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}
template <class Look>
[[nodiscard]] bool eventually(Look look) {
  return eventually(look, [] { return false; });
}

}  // namespace tessera
