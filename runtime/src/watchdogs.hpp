#pragma once

#include <memory>
#include <vector>

#include "subsystem_executor.hpp"

namespace tessera {

/// Watches, on the steady clock, the transition functions of subsystems with a watchdog. Under the simulated
/// clock a function that takes too long is known beforehand, and its executor raises the alarm itself.
///
/// Threads: one, not that of a subsystem.
class Watchdogs {
 public:
  /// lane: the calling thread's; nullptr: nothing is recorded.
  Watchdogs(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, RecordingLane* lane);
  /// Raises the alarm, once a call, where one has run too long. Returns when to look again; Time::max():
  /// never.
  [[nodiscard]] Time check(Time now);

 private:
  struct Watched {
    SubsystemExecutor* executor;
    Duration limit;
    std::int64_t alarmed_ns = -1;  // beginning of the last call that was too long
  };
  std::vector<Watched> watched_;
  RecordingLane* lane_;
};

}  // namespace tessera
