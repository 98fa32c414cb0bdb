#pragma once

#include <atomic>
#include <cstdint>

#include "network/carrier.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The values that observers of a link see: the messages between this process and another. Each value is
/// recent, but they may be from different moments.
///
/// Threads: written by that of the links, read by any.
struct alignas(64) LinkGauges {
  explicit LinkGauges(network::ProcessNumber its_peer) : peer(its_peer) {}

  const network::ProcessNumber peer;
  std::atomic<bool> reachable{false};
  std::atomic<std::int64_t> since_ns{0};            ///< of `reachable`
  std::atomic<std::int64_t> heard_ns{-1};           ///< the newest message or sign of life; -1: none yet
  std::atomic<std::uint64_t> sent{0}, repeated{0};  ///< messages; of these, values and recalls sent before
  /// Messages; of these, values and recalls that came before, or after newer ones.
  std::atomic<std::uint64_t> received{0}, duplicates{0};
  std::atomic<std::uint32_t> signs_expected{0}, signs_lost{0};            ///< as network::SignsOfLife
  std::atomic<std::int64_t> clock_ahead_ns{0}, clock_uncertainty_ns{-1};  ///< -1: not known

  void count_sent(bool again) {
    add_one(sent);
    if (again) add_one(repeated);
  }
  void hear(Time now, bool again) {
    set_reachable(true, now);
    set_heard(now);
    add_one(received);
    if (again) add_one(duplicates);
  }
  void set_reachable(bool is, Time now) {
    if (is) set_heard(now);
    if (reachable.load(std::memory_order_relaxed) == is) return;
    since_ns.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    reachable.store(is, std::memory_order_relaxed);
  }
  void set_signs(const network::SignsOfLife& signs, Time now) {
    set_heard(now);
    signs_expected.store(signs.expected, std::memory_order_relaxed);
    signs_lost.store(signs.lost, std::memory_order_relaxed);
    if (!signs.clock) return;
    clock_ahead_ns.store(signs.clock->ahead.count(), std::memory_order_relaxed);
    clock_uncertainty_ns.store(signs.clock->uncertainty.count(), std::memory_order_relaxed);
  }

 private:
  void set_heard(Time now) { heard_ns.store(now.time_since_epoch().count(), std::memory_order_relaxed); }
  static void add_one(std::atomic<std::uint64_t>& count) {  // only one thread writes it
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
};

}  // namespace tessera
