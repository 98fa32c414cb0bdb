// How old the commands at the end of a chain are, for observers of a running system.
#pragma once

#include <atomic>
#include <cstdint>

namespace tessera {

/// Times in nanoseconds; less than 0: none yet. Each value is recent, but they may be from different moments.
///
/// Threads: written by that of the last subsystem of the chain, except `first_reading_ns`, which is that of the first
///          one; read by any.
struct alignas(64) AgeGauges {
  static constexpr std::int64_t none = -1;

  std::atomic<std::uint64_t> commands{0};  ///< those that are based on a reading
  std::atomic<std::uint64_t> over{0};      ///< commands with an age or a reaction over its bound
  std::atomic<std::int64_t> age_ns{none}, longest_age_ns{none};
  std::atomic<std::int64_t> reaction_ns{none}, longest_reaction_ns{none};
  /// The first reading since the first subsystem has started.
  std::atomic<std::int64_t> first_reading_ns{none};

  void add_age(std::int64_t ns) { add(ns, age_ns, longest_age_ns); }
  void add_reaction(std::int64_t ns) { add(ns, reaction_ns, longest_reaction_ns); }

 private:
  static void add(std::int64_t ns, std::atomic<std::int64_t>& last, std::atomic<std::int64_t>& longest) {
    last.store(ns, std::memory_order_relaxed);
    if (ns > longest.load(std::memory_order_relaxed)) longest.store(ns, std::memory_order_relaxed);
  }
};

}  // namespace tessera
