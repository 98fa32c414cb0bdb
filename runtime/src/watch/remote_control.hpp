#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.hpp"
#include "system/stop_signals.hpp"
#include "watch/monitor_protocol.hpp"

namespace tessera {

/// What those who watch a run in simulated time have asked for: pause, single steps, breakpoints, speed
/// (tessera/monitor.hpp has the commands). Whatever is asked for, the run fires the same transitions at the
/// same simulated times.
///
/// Threads: `execute` and `shown` the watcher's, the rest the run's.
class RemoteControl {
 public:
  /// speed: simulated seconds a second; 0: as fast as possible.
  RemoteControl(Assembly& assembly, bool paused, double speed);
  ~RemoteControl();
  RemoteControl(const RemoteControl&) = delete;
  RemoteControl& operator=(const RemoteControl&) = delete;

  // ---- the watcher's
  /// What is wrong with the command; empty: it is done.
  [[nodiscard]] std::string execute(const SimulationCommand& command);
  [[nodiscard]] Snapshot::Simulation shown() const;
  /// What has been recorded shall be in the file soon.
  void show_recording() { recording_wanted_.store(true, std::memory_order_relaxed); }
  /// The run shall end because who started it has gone.
  void abandon();

  // ---- the run's
  [[nodiscard]] double speed() const { return speed_.load(std::memory_order_relaxed); }
  /// Whether `fired` has to be told of every firing by itself.
  [[nodiscard]] bool one_by_one() const { return one_by_one_.load(std::memory_order_relaxed); }
  /// Returns at once unless it is paused (false); else when that is over or a signal has come.
  bool wait_while_paused(const StopSignals& signals);
  /// Returns when it is time (false: before that, because of a command or a signal).
  [[nodiscard]] bool wait_for(Duration time, const StopSignals& signals);
  /// Around each firing that is told of.
  void about_to_fire();
  void fired(std::uint32_t instance);
  /// Writes what has been recorded into the file if somebody wants to see it.
  void keep_recording_live();

 private:
  struct Breakpoint {
    enum class When : std::uint8_t { marked, enabled, fires } when;
    std::string name;
    std::uint32_t instance = UINT32_MAX, channel = UINT32_MAX;  ///< one of them
    std::uint32_t index = 0;                                    ///< place or transition
    bool known = false, held = false;  ///< of marked and enabled: when it was last looked at
  };
  [[nodiscard]] bool resting() const { return paused_ && firings_left_ == 0 && !to_iteration_; }
  [[nodiscard]] bool find(Breakpoint& breakpoint) const;
  [[nodiscard]] bool holds(const Breakpoint& breakpoint) const;
  void look_at(Breakpoint& breakpoint, std::uint32_t fired);
  void set_paused(bool paused);
  // What `execute` does under its lock.
  [[nodiscard]] static std::string apply(const commands::Unknown& command);
  [[nodiscard]] std::string apply(const commands::Pause& command);
  [[nodiscard]] std::string apply(const commands::Resume& command);
  [[nodiscard]] std::string apply(const commands::StepFiring& command);
  [[nodiscard]] std::string apply(const commands::StepIteration& command);
  [[nodiscard]] std::string apply(const commands::SetSpeed& command);
  [[nodiscard]] std::string apply(const commands::SetBreakpoints& command);
  void update();
  void take_news() const;

  Assembly& assembly_;
  mutable std::mutex mutex_;
  bool paused_;
  std::uint64_t firings_left_ = 0;
  bool to_iteration_ = false;              ///< of iterating_, or of any
  std::uint32_t iterating_ = UINT32_MAX;   ///< UINT32_MAX: any
  std::vector<std::uint64_t> iterations_;  ///< when that was asked for; empty: to be filled by the run
  std::vector<Breakpoint> breakpoints_;
  std::string broke_at_;
  std::uint64_t pauses_ = 0;
  std::atomic<double> speed_;
  std::atomic<bool> one_by_one_{false}, recording_wanted_{false};
  int news_ = -1;  ///< eventfd: a command has come
};

}  // namespace tessera
