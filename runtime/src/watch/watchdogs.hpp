#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {

/// Watches, on the steady clock, the transition functions of subsystems with a watchdog. It also tells of calls that
/// have not returned and take longer than declared already; those that return are judged then (Overtimes).
/// Under the simulated clock, the duration of a function is known in advance, and its
/// executor raises the alarm itself.
///
/// Threads: one, not that of a subsystem.
class Watchdogs {
 public:
  /// secure: gives the devices of that subsystem their safe command, without waiting for them.
  /// lane: the calling thread's; nullptr: nothing is recorded.
  Watchdogs(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors,
            std::function<void(std::uint32_t)> secure, RecordingLane* lane);
  /// Raises the alarm, once per call, if a call has run too long. Returns when to look
  /// again; Time::max(): never.
  [[nodiscard]] Time check(Time now);

 private:
  /// A subsystem with `takes`, and a processor of its own.
  struct Declared {
    SubsystemExecutor* executor;
    Duration every;             // looks at it so often: twice in its period
    std::int64_t told_ns = -1;  // beginning of the last call that was longer
    std::uint64_t number = 0;   // of such calls
  };
  void look(Declared& one, Time now) const;

  struct Watched {
    SubsystemExecutor* executor;
    std::uint32_t instance;
    Duration limit;
    std::int64_t alarmed_ns = -1;  // beginning of the last call that took too long
  };
  std::vector<Watched> watched_;
  std::vector<Declared> declared_;
  Time next_look_{};
  Duration between_looks_{0};
  std::function<void(std::uint32_t)> secure_;
  RecordingLane* lane_;
};

}  // namespace tessera
