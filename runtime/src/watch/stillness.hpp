#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "assembly/assembly.hpp"
#include "system/waker.hpp"

namespace tessera {

/// "nothing can ever happen again: robot.control at follow.rcv.line.in waits for robot.sensor over 'line';
/// ...". For reports, when no subsystem runs.
[[nodiscard]] std::string why_nothing_happens(const Assembly& assembly);

/// Notices that all threads of a run wait for each other, which never ends.
///
/// A thread is at rest while it sleeps and only another thread can wake it. If all threads are at rest in
/// two successive looks, each in the same sleep both times, then all of them rested at the same time
/// between the looks: a thread that did not rest would have begun another sleep before the second look. So
/// no thread was left to wake any other.
///
/// Threads: one.
class Stillness {
 public:
  explicit Stillness(std::uint32_t threads) : rests_(threads), resting_(threads) {}
  /// Looks if it is time (next). words: the words on which the threads sleep; gone: whether a thread has
  /// ended. Also false if all have ended.
  [[nodiscard]] bool look(Time now, const WakeWord* words, const std::function<bool(std::uint32_t)>& gone);
  /// The threads that were at rest, in the same sleep, in the last two looks.
  [[nodiscard]] const std::vector<bool>& resting() const { return resting_; }
  /// Whether these threads, which were at rest in the last look, are in the same sleep now.
  [[nodiscard]] bool rest_still(const WakeWord* words, const std::vector<std::uint32_t>& threads) const;
  /// Whether the set of resting threads has changed since the look before. True once per look.
  [[nodiscard]] bool changed() { return std::exchange(changed_, false); }
  [[nodiscard]] Time next() const { return next_; }

 private:
  std::vector<std::uint64_t> rests_;  // per thread: its sleep at the last look; 0: it was not at rest
  std::vector<bool> resting_;
  bool changed_ = false;
  Time next_{};
};

}  // namespace tessera
