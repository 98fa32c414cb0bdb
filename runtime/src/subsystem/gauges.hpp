#pragma once

#include <atomic>
#include <cstdint>

#include "tessera/time.hpp"

namespace tessera {

/// What a subsystem shows to those who watch it while it runs. Each value is recent; they need not be of one
/// moment.
///
/// Threads: written by the subsystem's, read by any.
struct alignas(64) Gauges {
  std::atomic<std::uint64_t> iterations{0}, firings{0}, overruns{0}, errors{0};
  std::atomic<std::int64_t> called_at_ns{-1};  ///< when the last transition function began; -1: none yet
  std::atomic<std::int64_t> call_ns{0}, longest_call_ns{0};
  std::atomic<std::uint16_t> behaviour{0};  ///< the last that was called
  std::atomic<bool> calling{false};         ///< its transition function has not returned

  void begin_call(std::uint16_t called, Time now) {
    behaviour.store(called, std::memory_order_relaxed);
    called_at_ns.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    calling.store(true, std::memory_order_release);  // who sees it sees when it began
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
