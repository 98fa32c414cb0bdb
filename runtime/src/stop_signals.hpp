#pragma once

#include <csignal>

namespace tessera {

/// Catches SIGINT and SIGTERM while it lives. One that comes more than a second after the first kills as
/// usual, for runs whose user code hangs; earlier ones count as the same (a terminal and a parent may both
/// send it), so that the safe commands are given.
///
/// Threads: one object at a time per process; members from any thread.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  /// The signal that came first; 0: none.
  [[nodiscard]] static int pending();
  /// "SIGINT" or "SIGTERM".
  [[nodiscard]] static const char* name(int signal);
  /// Readable once a signal has come; -1 when the process has no descriptor left.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  struct sigaction before_interrupt_ {};
  struct sigaction before_terminate_ {};
};

}  // namespace tessera
