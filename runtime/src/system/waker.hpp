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

/// What one thread sleeps on: a futex word that remembers whether it was woken.
///
/// The sleeper takes a `ticket`, looks whether there is work, and then sleeps with that ticket: a wake-up
/// between the two makes the sleep return at once, so none is lost.
class alignas(64) WakeWord {
 public:
  /// Forgets earlier wake-ups. Threads: the sleeper's.
  [[nodiscard]] std::uint32_t ticket() {
    state_.exchange(awake, std::memory_order_acq_rel);
    return awake;
  }
  /// Threads: any. A system call only when somebody sleeps.
  void wake();
  /// Until woken since `ticket`, or until CLOCK_MONOTONIC shows `until_ns` (negative: no limit).
  void sleep(std::uint32_t ticket, std::int64_t until_ns);
  /// As sleep without a limit for those who look (`rest`), but it returns at `until_ns` so that the sleeper
  /// can do what is no work of the net. again: goes on with the rest of the call before, which was not woken.
  /// Returns whether it has been woken.
  [[nodiscard]] bool rest_until(std::uint32_t ticket, std::int64_t until_ns, bool again);
  /// While it sleeps without a limit: the number of that sleep, from 1; else 0. Threads: any.
  [[nodiscard]] std::uint64_t rest() const;

 private:
  static constexpr std::uint32_t awake = 0, woken = 1, asleep = 2, at_rest = 3;
  std::atomic<std::uint32_t> state_{awake};
  std::atomic<std::uint64_t> rests_{0};  // written by the sleeper
};

/// CLOCK_MONOTONIC in nanoseconds.
[[nodiscard]] std::int64_t monotonic_ns();

}  // namespace tessera
