#pragma once

#include <optional>
#include <span>

#include "tessera/result.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// Gives the calling thread the scheduling that its subsystem asks for, and touches its stack, so that no
/// page fault comes later. Returns what was not permitted.
[[nodiscard]] std::optional<Problem> schedule_this_thread(const RealTime& wanted);

/// A priority above that of every subsystem. The threads that watch over subsystems must run even if a
/// subsystem never releases its processor. 0: no subsystem asks for real time.
[[nodiscard]] int supervisor_priority(std::span<const Instance> instances);

/// Gives the calling thread a real-time priority while this object exists. Its new
/// threads do not inherit it.
///
/// Threads: made and destroyed by one.
class RealTimePriority {
 public:
  /// priority 0: nothing changes.
  explicit RealTimePriority(int priority);
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  ~RealTimePriority();
  /// The priority that was not permitted, and why.
  [[nodiscard]] const std::optional<Problem>& denied() const { return denied_; }
  /// The priority that the thread got; 0: the one that it had before.
  [[nodiscard]] int priority() const { return priority_; }

 private:
  int priority_ = 0, policy_before_ = 0, priority_before_ = 0;
  std::optional<Problem> denied_;
};

/// Keeps the memory of the process in RAM from now on. Returns why that was not permitted.
[[nodiscard]] std::optional<Problem> lock_memory();

[[nodiscard]] bool wants_realtime(std::span<const Instance> instances);

}  // namespace tessera
