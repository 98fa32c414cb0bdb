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
  /// Whether user code takes the time it declares (`takes`) rather than the time it takes.
  [[nodiscard]] virtual bool simulated() const = 0;
};

/// Moved by the simulation only.
class SimulatedClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return now_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool simulated() const override { return true; }
  void set(Time now) { now_.store(now, std::memory_order_relaxed); }

 private:
  std::atomic<Time> now_{};  // those who watch read it too
};

/// CLOCK_MONOTONIC from the moment it was made. It stands still while it is frozen, and goes on from there:
/// time in which the process was stopped is no time of the run.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override {
    for (;;) {
      // A thread may be stopped between its looks: what it has seen counts only if nothing has changed since.
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
  /// Threads: one that freezes and thaws, in turn.
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
  /// As CLOCK_MONOTONIC counts.
  [[nodiscard]] std::int64_t absolute_ns(Time time) const {
    return start_ns_.load(std::memory_order_relaxed) + time.time_since_epoch().count();
  }

 private:
  std::atomic<std::int64_t> start_ns_{monotonic_ns()};
  std::atomic<std::int64_t> frozen_ns_{-1};  // negative: it goes
  std::atomic<std::uint32_t> changes_{0};
};

}  // namespace tessera
