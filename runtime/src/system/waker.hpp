#pragma once

#include <atomic>
#include <cstdint>

#include "tessera/time.hpp"

namespace tessera {

/// Makes a subsystem check its net again.
class Waker {
 public:
  virtual ~Waker() = default;
  /// Threads: any. Never blocks.
  virtual void wake(std::uint32_t instance) = 0;
};

/// The word on which one thread sleeps: a futex that remembers whether it was woken.
///
/// The sleeper takes a `ticket`, checks whether there is work, and then sleeps with that ticket. A wake-up
/// between the two makes the sleep return at once, so no wake-up is lost.
class alignas(64) WakeWord {
 public:
  /// Forgets earlier wake-ups. Threads: the sleeper's.
  [[nodiscard]] std::uint32_t ticket() {
    state_.exchange(awake, std::memory_order_acq_rel);
    return awake;
  }
  /// Threads: any. Makes a system call only if a thread sleeps.
  void wake();
  /// Sleeps until woken since `ticket`, or until CLOCK_MONOTONIC shows `until_ns` (negative: no limit). Returns the
  /// moment at which it might go on: the earlier of the two; negative: it did not sleep, or neither has come.
  std::int64_t sleep(std::uint32_t ticket, std::int64_t until_ns);
  /// Observers (`rest`) see it as a sleep without a limit, but it returns at `until_ns` so that the
  /// sleeper can do work outside the net. again: continues the previous call, which was not woken.
  /// Returns whether it was woken.
  [[nodiscard]] bool rest_until(std::uint32_t ticket, std::int64_t until_ns, bool again);
  /// The number of the current sleep without a limit, from 1; 0: there is none. Threads: any.
  [[nodiscard]] std::uint64_t rest() const;

 private:
  static constexpr std::uint32_t awake = 0, woken = 1, asleep = 2, at_rest = 3;
  std::atomic<std::uint32_t> state_{awake};
  std::atomic<std::uint64_t> rests_{0};    // written by the sleeper
  std::atomic<std::int64_t> woken_ns_{0};  // when a sleeper was woken last
};

/// CLOCK_MONOTONIC in nanoseconds.
[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace tessera
