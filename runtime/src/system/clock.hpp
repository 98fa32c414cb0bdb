#pragma once

#include <atomic>
#include <cstdint>

#include "system/waker.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The time of a run.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Threads: any.
  [[nodiscard]] virtual Time now() const = 0;
  /// Whether a transition function takes the time that it declares (`takes`), and not the
  /// time that it really takes.
  [[nodiscard]] virtual bool simulated() const = 0;
};

/// Moved only by the simulation.
class SimulatedClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return now_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool simulated() const override { return true; }
  void set(Time now) { now_.store(now, std::memory_order_relaxed); }

 private:
  std::atomic<Time> now_{};  // observers read it, too
};

/// CLOCK_MONOTONIC from the moment when the object was made. While it is frozen, it stands still;
/// afterwards it goes on from there. So the time in which the process was suspended does not count.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override {
    for (;;) {
      // A thread may be interrupted between the two loads: the result counts only if
      // nothing has changed since.
      const std::uint32_t change = changes_.load(std::memory_order_seq_cst);
      const std::int64_t frozen_ns = frozen_ns_.load(std::memory_order_seq_cst),
                         passed_ns = monotonic_ns() - start_ns_.load(std::memory_order_seq_cst);
      if (changes_.load(std::memory_order_seq_cst) == change)
        return Time(Duration(frozen_ns >= 0 ? frozen_ns : passed_ns));
    }
  }
  [[nodiscard]] bool simulated() const override { return false; }
  /// Time zero is now. Only while no other thread uses the clock.
  void restart() { start_ns_ = monotonic_ns(); }
  /// Threads: one thread, which freezes and thaws in turn.
  void freeze() {
    const std::int64_t at_ns = monotonic_ns() - start_ns_;
    frozen_ns_ = at_ns;
    ++changes_;
  }
  void thaw() {
    start_ns_ = monotonic_ns() - frozen_ns_;
    ++changes_;
    frozen_ns_ = -1;
    ++changes_;
  }
  /// Another number after it was frozen or went on. Threads: any.
  [[nodiscard]] std::uint32_t changes() const { return changes_.load(std::memory_order_relaxed); }
  /// As counted by CLOCK_MONOTONIC.
  [[nodiscard]] std::int64_t absolute_ns(Time time) const {
    return start_ns_.load(std::memory_order_relaxed) + time.time_since_epoch().count();
  }

 private:
  std::atomic<std::int64_t> start_ns_{monotonic_ns()};
  std::atomic<std::int64_t> frozen_ns_{-1};  // negative: the clock runs
  std::atomic<std::uint32_t> changes_{0};
};

}  // namespace tessera
