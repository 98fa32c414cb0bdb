#pragma once

#include <span>
#include <string>

#include "tessera/tables.hpp"

namespace tessera {

/// Gives the calling thread the scheduling that its subsystem asks for, and touches its stack, so that no
/// page fault comes later. Empty, or what was not permitted.
[[nodiscard]] std::string schedule_this_thread(const RealTime& wanted);

/// Above every subsystem: what watches over them must run although one of them does not let go of its
/// processor. 0: none of them asks for real time.
[[nodiscard]] int supervisor_priority(std::span<const Instance> instances);

/// Gives the calling thread a real-time priority while it lives. Threads that it makes do not inherit it.
///
/// Threads: made and destroyed by one.
class RealTimePriority {
 public:
  /// priority 0: as it was.
  explicit RealTimePriority(int priority);
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  ~RealTimePriority();
  /// Empty, or what was not permitted.
  [[nodiscard]] const std::string& denied() const { return denied_; }
  /// What it has; 0: what it had before.
  [[nodiscard]] int priority() const { return priority_; }

 private:
  int priority_ = 0, policy_before_ = 0, priority_before_ = 0;
  std::string denied_;
};

/// Keeps the memory of the process in RAM from now on. Empty, or why that was not permitted.
[[nodiscard]] std::string lock_memory();

[[nodiscard]] bool wants_realtime(std::span<const Instance> instances);

}  // namespace tessera
