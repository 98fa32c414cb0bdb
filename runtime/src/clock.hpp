#pragma once

#include <atomic>

#include "tessera/time.hpp"
#include "waker.hpp"

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

/// CLOCK_MONOTONIC from the moment it was made.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return Time(Duration(monotonic_ns() - start_ns_)); }
  [[nodiscard]] bool simulated() const override { return false; }
  /// Time zero is now. Only while no other thread uses the clock.
  void restart() { start_ns_ = monotonic_ns(); }
  /// As CLOCK_MONOTONIC counts.
  [[nodiscard]] std::int64_t absolute_ns(Time time) const {
    return start_ns_ + time.time_since_epoch().count();
  }

 private:
  std::int64_t start_ns_ = monotonic_ns();
};

}  // namespace tessera
