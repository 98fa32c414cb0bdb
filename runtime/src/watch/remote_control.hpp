#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.hpp"
#include "system/stop_signals.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/ids.hpp"
#include "tessera/result.hpp"

namespace tessera {

/// Requests of clients that watch a run in simulated time: pause, single steps, breakpoints, speed
/// (tessera/monitor.hpp has the commands). They change neither the transitions that the run fires nor their
/// simulated times.
///
/// Threads: `execute` and `shown` the watcher's, the rest the run's.
class RemoteControl {
 public:
  /// speed: simulated seconds per second of real time; 0: as fast as possible.
  RemoteControl(Assembly& assembly, bool paused, double speed);
  ~RemoteControl();
  RemoteControl(const RemoteControl&) = delete;
  RemoteControl& operator=(const RemoteControl&) = delete;

  // ---- the watcher's
  /// Executes the command. Returns its mistake.
  [[nodiscard]] std::optional<Problem> execute(const SimulationCommand& command);
  [[nodiscard]] Snapshot::Control shown() const;
  /// Requests that recorded events reach the file soon.
  void show_recording() { recording_wanted_.store(true, std::memory_order_relaxed); }
  /// Ends the run because the client that started it has gone.
  void abandon();

  // ---- the run's
  /// As the command of that name.
  void pause();
  [[nodiscard]] double speed() const { return speed_.load(std::memory_order_relaxed); }
  /// Whether `fired` must be called after every single firing.
  [[nodiscard]] bool one_by_one() const { return one_by_one_.load(std::memory_order_relaxed); }
  /// Returns false at once if the run is not paused; otherwise waits until it continues or a signal comes.
  bool wait_while_paused(const StopSignals& signals);
  /// Returns true when the time has passed, and false if a command or a signal came before.
  [[nodiscard]] bool wait_for(Duration time, const StopSignals& signals);
  /// Called around each firing that must be reported.
  void about_to_fire();
  void fired(std::uint32_t instance);
  /// Writes recorded events to the file if a client wants to see them.
  void keep_recording_live();

 private:
  struct Breakpoint {
    enum class When : std::uint8_t { marked, enabled, fires } when;
    std::string name;
    InstanceId instance{};  ///< valid, or
    ChannelId channel{};
    std::uint32_t index = 0;           ///< place or transition
    bool known = false, held = false;  ///< marked and enabled breakpoints: the state at the last look
  };
  [[nodiscard]] bool resting() const { return paused_ && firings_left_ == 0 && !to_iteration_; }
  [[nodiscard]] bool find(Breakpoint& breakpoint) const;
  [[nodiscard]] bool holds(const Breakpoint& breakpoint) const;
  void look_at(Breakpoint& breakpoint, std::uint32_t fired);
  void set_paused(bool paused);
  // The part of `execute` that needs its lock.
  [[nodiscard]] std::optional<Problem> apply(const command::Pause& command);
  [[nodiscard]] std::optional<Problem> apply(const command::Resume& command);
  [[nodiscard]] std::optional<Problem> apply(const command::StepFiring& command);
  [[nodiscard]] std::optional<Problem> apply(const command::StepIteration& command);
  [[nodiscard]] std::optional<Problem> apply(const command::Speed& command);
  [[nodiscard]] std::optional<Problem> apply(const command::Breakpoints& command);
  void update();
  void take_news() const;

  Assembly& assembly_;
  mutable std::mutex mutex_;
  bool paused_;
  bool stands_ = false;  ///< the run waits, and all its firings are in its recording
  std::uint64_t firings_left_ = 0;
  bool to_iteration_ = false;              ///< of iterating_, or of any subsystem
  InstanceId iterating_{};                 ///< none: any
  std::vector<std::uint64_t> iterations_;  ///< at the time of the request; empty: to be filled by the run
  std::vector<Breakpoint> breakpoints_;
  std::string broke_at_;
  std::uint64_t pauses_ = 0;
  std::atomic<double> speed_;
  std::atomic<bool> one_by_one_{false}, recording_wanted_{false};
  int news_ = -1;  ///< eventfd: a command has come
};

}  // namespace tessera
