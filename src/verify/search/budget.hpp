#pragma once

#include <algorithm>
#include <chrono>

#include "explore/watch.hpp"

namespace tessera::verify {

/// Computes how much of its limits a question that takes several explorations has left.
class Budget {
 public:
  explicit Budget(const explore::Limits& limits) : limits_(limits), start_(Clock::now()) {}

  [[nodiscard]] explore::Limits left() const {
    explore::Limits left = limits_;
    left.time = limits_.time - std::chrono::duration<double>(Clock::now() - start_);
    left.time = std::max(left.time, std::chrono::duration<double>(0));
    return left;
  }

  /// No time is left, or the search was told to stop.
  [[nodiscard]] bool spent() const {
    return left().time.count() <= 0 || (limits_.stop != nullptr && limits_.stop->load());
  }

 private:
  using Clock = std::chrono::steady_clock;
  const explore::Limits& limits_;
  Clock::time_point start_;
};

}  // namespace tessera::verify
