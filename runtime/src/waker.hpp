#pragma once

#include <atomic>
#include <cstdint>

#include "tessera/time.hpp"

namespace tessera {

/// Makes a subsystem look at its net again.
class Waker {
 public:
  virtual ~Waker() = default;
  /// Threads: any. Never blocks.
  virtual void wake(std::uint32_t instance) = 0;
};

/// What one thread sleeps on: a futex word that counts wake-ups.
///
/// The sleeper takes a `ticket`, looks whether there is work, and then sleeps with that ticket: a wake-up
/// between the two makes the sleep return at once, so none is lost.
class alignas(64) WakeWord {
 public:
  [[nodiscard]] std::uint32_t ticket() const { return wakes_.load(std::memory_order_seq_cst); }
  /// Threads: any. A system call only when somebody sleeps.
  void wake();
  /// Until woken since `ticket`, or until CLOCK_MONOTONIC shows `until_ns` (negative: no limit).
  void sleep(std::uint32_t ticket, std::int64_t until_ns);

 private:
  std::atomic<std::uint32_t> wakes_{0};
  std::atomic<bool> sleeping_{false};
};

/// CLOCK_MONOTONIC in nanoseconds.
[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace tessera
