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
/// ..." For reports, when no subsystem runs.
[[nodiscard]] std::string why_nothing_happens(const Assembly& assembly);

/// Notices that all threads of a run wait for each other, which is for ever.
///
/// A thread is at rest while it sleeps with nothing but another thread to wake it. When all are found at rest
/// in two looks, each in the same sleep both times, then between the looks all of them rested at once: who
/// did not would have had to begin another sleep before the second. Then nobody was left to wake anybody.
///
/// Threads: one that looks.
class Stillness {
 public:
  explicit Stillness(std::uint32_t threads) : rests_(threads), resting_(threads) {}
  /// Looks if it is time (next). words: what the threads sleep on; gone: whether that one has ended. false
  /// also when all have.
  [[nodiscard]] bool look(Time now, const WakeWord* words, const std::function<bool(std::uint32_t)>& gone);
  /// Who was at rest, in the same sleep, in the last two looks.
  [[nodiscard]] const std::vector<bool>& resting() const { return resting_; }
  /// Whether these, who were at rest in the last look, are in the same sleep now.
  [[nodiscard]] bool rest_still(const WakeWord* words, const std::vector<std::uint32_t>& threads) const;
  /// Whether somebody rests now who did not at the look before, or the other way round. Once a look.
  [[nodiscard]] bool changed() { return std::exchange(changed_, false); }
  [[nodiscard]] Time next() const { return next_; }

 private:
  std::vector<std::uint64_t> rests_;  // per thread: its sleep at the last look; 0: it was not at rest
  std::vector<bool> resting_;
  bool changed_ = false;
  Time next_{};
};

}  // namespace tessera
