#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "assembly/assembly.hpp"
#include "assembly/upper_layers.hpp"
#include "managed/run_orders.hpp"
#include "run/give_up.hpp"
#include "run/simulated_run.hpp"
#include "safety/securing.hpp"
#include "system/stop_signals.hpp"
#include "watch/emergency_watch.hpp"
#include "watch/liveness.hpp"
#include "watch/monitor.hpp"
#include "watch/ros2_host.hpp"
#include "watch/status_sender.hpp"
#include "watch/stillness.hpp"
#include "watch/stuck.hpp"

namespace tessera {

/// Runs every subsystem in a thread of its own, in real time. One more thread moves the simulated world, if
/// there is one. The calling thread fires the transitions of the upper layers, watches the clock and the
/// signals, and wakes all threads when the run is to end.
class SteadyRun final : public Waker {
 public:
  /// give_up: must outlive it.
  SteadyRun(std::uint32_t instances, const GiveUp& give_up);
  SteadyRun(const SteadyRun&) = delete;
  SteadyRun& operator=(const SteadyRun&) = delete;
  ~SteadyRun() override;
  [[nodiscard]] const SteadyClock& clock() const { return clock_; }
  void wake(std::uint32_t instance) override { wake_words_[instance].wake(); }
  /// Call it before the devices are opened: an emergency stop that comes then is in force from the start.
  /// Returns why nobody can reach the run; nullopt: it can be reached, or is not to be.
  [[nodiscard]] std::optional<Problem> listen(const Assembly& assembly);
  [[nodiscard]] Ending run(Assembly& assembly, UpperLayers& upper, const StopSignals& signals);
  /// Threads that run user code go on and use all of this: the process must end (GiveUp::end_process).
  [[nodiscard]] bool has_given_up() const { return given_up_after_.has_value(); }

 private:
  void run_subsystem(SubsystemExecutor& executor, std::uint32_t instance, RunControl& control);
  std::int64_t sleep(SubsystemExecutor& executor, WakeWord& wakes, std::uint32_t ticket,
                     const SubsystemExecutor::Progress& progress, const RunControl& control) const;
  void step_until_end(SubsystemExecutor& executor, WakeWord& wakes, const RunControl& control) const;
  void run_world(Assembly& assembly);
  void run_links(Assembly& assembly);
  void say_world_is_slow();
  void start_threads(Assembly& assembly);
  void tell_supervisor() const;
  void deny(const Problem& what);
  void supervise(Assembly& assembly, UpperLayers& upper, Securing& securing);
  void follow_emergency(EmergencyWatch& emergencies, const RunControl& control, Securing& securing,
                        RecordingLane* lane) const;
  static void collect_secured(RunControl& control, Securing& securing, RecordingLane* lane);
  [[nodiscard]] Time follow_safe_commands(Assembly& assembly, Securing& securing, Time now);
  void hold_the_others(const Assembly& assembly, Securing& securing, Time now);
  // Standing still for a while: steady_hold.cpp.
  void suspend(Assembly& assembly, Securing& securing);
  [[nodiscard]] static bool any_owing(const Assembly& assembly);
  [[nodiscard]] static bool all_safe(const Assembly& assembly);
  void stop_process(Time since, RecordingLane* lane);
  void stand_still(RunControl& control);
  void move_on();
  [[nodiscard]] bool asked_to_hold(RunControl& control);
  void hold(Assembly& assembly, Securing& securing, EmergencyWatch& emergencies);
  [[nodiscard]] Time show_life();
  [[nodiscard]] Ending ending(const Assembly& assembly, const UpperLayers& upper) const;
  void look_for_stuck(Assembly& assembly, const Stillness& stillness, Securing& securing, Time now);
  void collect_ended(const Assembly& assembly, UpperLayers& upper);
  void await_news(Time until) const;
  // The end of the run: steady_end.cpp.
  // Waits until the threads of all subsystems have ended, or gives up. Reports the subsystems that it waits
  // for, and secures their devices.
  void await_threads(const Assembly& assembly, Securing& securing);
  void say_waiting(const Assembly& assembly, const Securing& securing, Duration since) const;
  [[nodiscard]] bool gives_up(const Assembly& assembly, Duration waited) const;
  [[nodiscard]] bool has_ended(std::uint32_t instance) const;
  void secure_devices(Securing& securing) const;
  void end_threads(Assembly& assembly, Securing& securing);
  void wake_all(const Assembly& assembly);

  const GiveUp& give_up_;
  SteadyClock clock_;
  std::unique_ptr<WakeWord[]> wake_words_;
  std::unique_ptr<std::atomic<bool>[]> gone_;  // per instance: its thread has ended
  WakeWord world_wakes_;
  std::vector<bool> collected_;
  StuckWatch stuck_;
  std::optional<Liveness> liveness_;          // until the threads have ended
  std::optional<Time> told_of_resistance_{};  // when that was said last
  int news_ = -1;                             // eventfd: a subsystem has ended or the run is to stop
  std::uint32_t started_ = 0;                 // number of instances whose threads have been started
  bool duration_over_ = false;
  std::optional<RunOrders> orders_;  // of the process that may hold the run
  bool holds_ = false;               // the clock stands
  std::atomic<bool> net_ended_{false};
  Time world_time_{};                       // used by the world's thread while it runs
  bool world_is_slow_ = false;              // used by the world's thread while it runs
  std::atomic<bool> denied_{false};         // it has been reported that real time was not permitted
  std::optional<Duration> given_up_after_;  // since the stop
  std::string given_up_;                    // "; " and the subsystems that did not end
  std::vector<bool> left_behind_;           // as Ending::left_behind
  std::vector<std::thread> threads_;        // per instance
  std::vector<std::thread> beside_;         // of the world and of the links
  std::optional<Securing> securing_;
  std::unique_ptr<MonitorSocket> listening_;  // until there is a monitor
  std::optional<Monitor> monitor_;            // the last members: they look at the others
  std::optional<StatusSender> status_;
  std::unique_ptr<ShownInRos2> shown_;
};

}  // namespace tessera
