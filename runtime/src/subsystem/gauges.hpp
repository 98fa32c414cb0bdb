#pragma once

#include <atomic>
#include <cstdint>

#include "tessera/time.hpp"

namespace tessera {

/// The values that observers of a running subsystem see. Each value is recent, but they may be
/// from different moments.
///
/// Threads: written by the subsystem's, read by any.
struct alignas(64) Gauges {
  std::atomic<std::uint64_t> iterations{0}, firings{0}, overruns{0}, errors{0};
  std::atomic<std::int64_t> called_at_ns{-1};  ///< when the last transition function began; -1: none yet
  std::atomic<std::int64_t> call_ns{0}, longest_call_ns{0};
  /// Calls that took longer than declared, and how often the thread went on later than the latency allows.
  std::atomic<std::uint64_t> slow_calls{0}, late_wakeups{0};
  std::atomic<std::int64_t> latest_wakeup_ns{0};  ///< the most time until the thread went on after it might
  /// When it last came to a rest: nothing could fire. It counts while it still waits.
  std::atomic<std::int64_t> waits_since_ns{-1};
  std::atomic<std::uint16_t> behaviour{0};  ///< the behaviour that was called last, or has begun to receive
  std::atomic<bool> calling{false};         ///< the transition function has not returned

  void begin_call(std::uint16_t called, Time now) {
    behaviour.store(called, std::memory_order_relaxed);
    called_at_ns.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    calling.store(true, std::memory_order_release);  // an observer that sees it also sees when the call began
  }
  void end_call(Time now) {
    const std::int64_t took = now.time_since_epoch().count() - called_at_ns.load(std::memory_order_relaxed);
    call_ns.store(took, std::memory_order_relaxed);
    if (took > longest_call_ns.load(std::memory_order_relaxed))
      longest_call_ns.store(took, std::memory_order_relaxed);
    calling.store(false, std::memory_order_relaxed);
  }
};

}  // namespace tessera
