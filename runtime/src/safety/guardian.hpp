#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "system/process_watch.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// A process that gives devices their safe command when the controller cannot do so any more:
/// the controller has died (SIGKILL, _exit, a crash), or it stands still as a whole. The guardian
/// serves the drivers that derive from Guarded (tessera/device.hpp). It makes its own objects of them,
/// which open the devices again.
///
/// It is forked before the first driver is made and before the run has threads. It has its own session,
/// ignores every signal that can be ignored, and ends with the controller.
///
/// *Standing still*: the run has not called `beat` for stands_still_after. If the process is
/// stopped (SIGSTOP, a debugger), the devices get their safe command, and `has_acted` says so
/// when the process continues. Otherwise the process is killed first, so that none of its threads
/// commands the devices afterwards.
///
/// It gives signs of life itself: a guardian that is stopped protects nothing.
///
/// Threads: `announce_death` any, also in a signal handler; `look_at_it` one; the rest the run's.
class Guardian {
 public:
  static constexpr Duration stands_still_after = std::chrono::seconds(2);
  static constexpr Duration beat_period = std::chrono::milliseconds(200);
  /// How long it tries if a device refuses or does not answer.
  static constexpr Duration patience = std::chrono::seconds(5);

  /// Whether such a run has a driver that the guardian can serve.
  [[nodiscard]] static bool is_needed(const System& system, const RunOptions& options);
  /// Forks the guardian and waits until it is ready. nullptr and `error`: it cannot serve the drivers.
  [[nodiscard]] static std::unique_ptr<Guardian> start(const System& system, const RunOptions& options,
                                                       std::string& error);
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;
  /// Waits for the end of the guardian. If `dismiss` was not called, the guardian gives the safe commands
  /// when this process has died.
  ~Guardian();

  /// The run begins or continues: from now on it has to beat.
  void watch_beats();
  /// The run ends, or is suspended: it need not beat.
  void ignore_beats();
  void beat();
  /// All devices are safe and closed: the guardian ends.
  void dismiss();
  /// This process is about to die.
  void announce_death();
  /// Whether the guardian has given the safe commands although this process lives. After `dismiss` it does so
  /// no more.
  [[nodiscard]] const std::atomic<bool>& has_acted() const;

  /// A reason why the run has failed, whatever ends it.
  enum class Trouble : std::uint8_t {
    none,
    acted,        ///< has_acted
    ended,        ///< its process has ended
    stands_still  ///< it has given no sign of life for stands_still_after
  };
  /// Ask it last: after `dismiss`, the answer does not change.
  [[nodiscard]] Trouble trouble() const;
  /// Empty for `none`.
  [[nodiscard]] static std::string_view describe(Trouble trouble);
  /// Call it once in every beat_period: it counts these calls and not the time, because a machine that sleeps or is
  /// overloaded delays both processes.
  void look_at_it();
  /// The process of the guardian has ended.
  void note_end();
  [[nodiscard]] bool is_dismissed() const;
  [[nodiscard]] pid_t process() const { return process_; }

  /// The data that both processes share.
  struct Shared;

 private:
  Guardian(Shared* shared, int news, pid_t process) : shared_(shared), news_(news), process_(process) {}
  void tell() const;
  Shared* shared_;
  int news_;  // eventfd: the guardian shall look
  pid_t process_;
  std::atomic<Trouble> noticed_{Trouble::none};
  std::uint64_t signs_ = 0;  // of life, at the last look
  unsigned looks_ = 0;       // without one
};

}  // namespace tessera
