#pragma once

#include <time.h>

#include <atomic>
#include <cstddef>
#include <memory>

#include "tessera/time.hpp"

namespace tessera {

/// The clocks of threads that share a processor. They tell how long the others ran on it.
class ProcessorClocks {
 public:
  explicit ProcessorClocks(std::size_t threads)
      : clocks_(std::make_unique<std::atomic<clockid_t>[]>(threads)), threads_(threads) {
    for (std::size_t thread = 0; thread < threads; ++thread) clocks_[thread] = none;
  }
  /// The calling thread is the one with that number.
  void enter(std::size_t thread);
  /// The processor time of the others so far. Threads that have not begun, or have ended, count nothing.
  [[nodiscard]] Duration used_by_others(std::size_t thread) const;

 private:
  static constexpr clockid_t none = -1;
  std::unique_ptr<std::atomic<clockid_t>[]> clocks_;
  std::size_t threads_;
};

}  // namespace tessera
