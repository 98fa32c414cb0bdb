#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "system/process_watch.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// A process that gives devices their safe command when the controller cannot do so any more: it has died
/// (SIGKILL, _exit, a crash), or it stands still as a whole. It serves the drivers that derive from Guarded
/// (tessera/device.hpp); it makes objects of them of its own, which open the devices anew.
///
/// It is forked before the first driver is made and before the run has threads, has a session of its own,
/// ignores every signal that can be ignored, and ends with the controller.
///
/// *Standing still*: the run has not called `beat` for stands_still_after. If the process is stopped
/// (SIGSTOP, a debugger), the devices get their safe command, and `has_acted` says so when it goes on.
/// Otherwise it is killed first, so that no other thread of it commands them afterwards.
///
/// Threads: `announce_death` any, also in a signal handler; the rest the run's.
class Guardian {
 public:
  static constexpr Duration stands_still_after = std::chrono::seconds(2);
  static constexpr Duration beat_period = std::chrono::milliseconds(200);
  /// So long it tries where a device refuses, or does not answer.
  static constexpr Duration patience = std::chrono::seconds(5);

  /// Whether some driver is there that it can serve in such a run.
  [[nodiscard]] static bool is_needed(const System& system, const RunOptions& options);
  /// Forks it, and waits until it is ready. nullptr and `error`: it cannot serve the drivers.
  [[nodiscard]] static std::unique_ptr<Guardian> start(const System& system, const RunOptions& options,
                                                       std::string& error);
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  /// Waits for its end. If `dismiss` was not called, it gives the safe commands when this process has died.
  ~Guardian();

  /// The run begins or goes on: from now on it has to beat.
  void watch_beats();
  /// The run ends, or stops for a while: it need not beat.
  void ignore_beats();
  void beat();
  /// All devices are safe and closed: it has nothing to do any more.
  void dismiss();
  /// This process is about to die.
  void announce_death();
  /// It has given the safe commands although this process lives.
  [[nodiscard]] bool has_acted() const;
  [[nodiscard]] bool is_dismissed() const;
  [[nodiscard]] pid_t process() const { return process_; }

  /// What both processes see.
  struct Shared;

 private:
  Guardian(Shared* shared, int news, pid_t process) : shared_(shared), news_(news), process_(process) {}
  void tell() const;
  Shared* shared_;
  int news_;  // eventfd: it shall look
  pid_t process_;
};

}  // namespace tessera
