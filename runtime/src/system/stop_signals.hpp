#pragma once

#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "tessera/signals.hpp"

namespace tessera {

/// Handles every signal of tessera/signals.hpp while this object exists. It notes those that stop
/// or suspend a run, and makes writing fail where a signal would end the process. SIGINT and SIGTERM
/// are always handled. Another signal that is handled or ignored already (nohup, a driver with a
/// handler) is left as it is.
///
/// SIGINT, SIGQUIT or SIGTERM more than a second after the first signal kills as usual, for runs whose
/// user code hangs. Earlier ones count as the same signal (a terminal and a parent may both send it), so
/// that the safe commands are given.
///
/// Threads: one object at a time per process, or several nested ones, of which the outermost
///          counts; members from any thread.
class StopSignals {
 public:
  /// The effect of SIGTSTP.
  enum class Suspension : std::uint8_t {
    usual,    ///< stops the process for a while; only if nothing real moves
    noted,    ///< sets suspension_asked
    ends_run  ///< ends the run like other signals: no thread could suspend it safely
  };
  explicit StopSignals(Suspension suspension = Suspension::usual);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  /// The first signal that has come of those that stop a run; 0: none.
  [[nodiscard]] static int pending();
  [[nodiscard]] static std::string name(int signal) { return signal_name(signal); }
  /// Whether SIGTSTP has come and resume has not been called since.
  [[nodiscard]] static bool suspension_asked();
  /// Forgets the SIGTSTP.
  static void resume();
  /// Readable once a signal has arrived; -1: the process has no descriptor left.
  [[nodiscard]] static int descriptor();
  /// Makes the descriptor unreadable until the next signal.
  static void take_news();

 private:
  struct Before {
    int signal;
    struct sigaction action;
  };
  std::vector<Before> before_;
  bool outermost_ = false;
};

}  // namespace tessera
