#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {

/// Watches, on the steady clock, the transition functions of subsystems with a watchdog.
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
  struct Watched {
    SubsystemExecutor* executor;
    std::uint32_t instance;
    Duration limit;
    std::optional<std::int64_t> alarmed_ns{};  // beginning of the last call that took too long
  };
  std::vector<Watched> watched_;
  std::function<void(std::uint32_t)> secure_;
  RecordingLane* lane_;
};

}  // namespace tessera
