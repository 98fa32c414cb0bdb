#pragma once

#include <cstddef>

namespace tessera {

class SubsystemExecutor;

/// Notes which subsystem the calling thread executes while this object exists, so that the message about a
/// crash can name the behaviour that ran.
///
/// Threads: each has its own note. `current` may be called in a signal handler.
class RunningSubsystem {
 public:
  explicit RunningSubsystem(SubsystemExecutor& executor) : before_(current_) { current_ = &executor; }
  RunningSubsystem(const RunningSubsystem&) = delete;
  RunningSubsystem& operator=(const RunningSubsystem&) = delete;
  ~RunningSubsystem() { current_ = before_; }

  /// nullptr: none.
  [[nodiscard]] static SubsystemExecutor* current() { return current_; }

 private:
  inline static constinit thread_local SubsystemExecutor* current_ = nullptr;
  SubsystemExecutor* before_;
};

/// A second stack of the calling thread while this object exists. A signal handler can run on it when the
/// first stack has overflowed. A thread that has one already keeps it.
///
/// Threads: constructed and destroyed by the same one.
class AlternateStack {
 public:
  AlternateStack();
  AlternateStack(const AlternateStack&) = delete;
  AlternateStack& operator=(const AlternateStack&) = delete;
  ~AlternateStack();

 private:
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace tessera
