#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"
#include "assembly/upper_layers.hpp"
#include "drivers/ros2_clock.hpp"
#include "run/process_lives.hpp"
#include "system/deadline_queue.hpp"
#include "system/stop_signals.hpp"
#include "watch/call_watch.hpp"
#include "watch/emergency_watch.hpp"
#include "watch/monitor.hpp"
#include "watch/remote_control.hpp"
#include "watch/stuck.hpp"

namespace tessera {

/// How a run ended.
struct Ending {
  std::string text;  ///< see RunSummary::ended
  bool failed = false;
  Time at{};
  int signal = 0;                        ///< the signal that ended the run; 0: none
  std::optional<Duration> world_time{};  ///< if a world was slower than real time: the time that it reached
  RunSummary::Failure failure = RunSummary::Failure::none;
  /// Per instance: whether its thread still runs user code, because the run has given up. Empty: none.
  std::vector<bool> left_behind{};
};

/// Runs all subsystems in one thread, in simulated time. At each instant, the subsystems that can act take
/// turns in an order drawn from the seed, each until it has to wait, or firing by firing
/// (RunOptions::interleave). When none can act, time jumps to the next deadline, and the world moves with it.
/// A scenario comes first: its subsystems take turns as it says, and time waits only for them. One of times says how
/// long calls take, and the order of those that can act at one instant; the run ends with it. Everything except the real-time speed depends only on tables, seed and user code.
class SimulatedRun final : public Waker {
 public:
  SimulatedRun(std::uint32_t instances, std::uint64_t seed);
  [[nodiscard]] const SimulatedClock& clock() const { return clock_; }
  /// Before `run`. Throws DriverError.
  void publish_clock(const std::string& interface) { published_.emplace(interface); }
  void wake(std::uint32_t instance) override;
  [[nodiscard]] Ending run(Assembly& assembly, UpperLayers& upper, const StopSignals& signals);

 private:
  [[nodiscard]] Ending run_until_end(Assembly& assembly, UpperLayers& upper, const StopSignals& signals);
  /// nullopt: the scenario was followed to its end, or there is none.
  [[nodiscard]] std::optional<Ending> follow_scenario(Assembly& assembly, UpperLayers& upper);
  [[nodiscard]] bool follow_step(Assembly& assembly, UpperLayers& upper, std::size_t index);
  /// Names the subsystems that have not fired since the scenario, because a scenario is there to show them.
  [[nodiscard]] Ending with_stuck(Ending ending, const Assembly& assembly) const;
  [[nodiscard]] std::uint32_t draw_ready(const Assembly& assembly);
  [[nodiscard]] bool fire_what_is_ready(Assembly& assembly, UpperLayers& upper, const StopSignals& signals);
  void step(Assembly& assembly, UpperLayers& upper, std::uint32_t instance);
  [[nodiscard]] bool serve_links(Assembly& assembly);
  [[nodiscard]] Time next_of_links(const Assembly& assembly) const;
  void move_to(Assembly& assembly, Time time);
  [[nodiscard]] std::optional<Ending> stopped(const Assembly& assembly) const;
  [[nodiscard]] Ending with_failure_of_world(Ending ending, Assembly& assembly) const;
  void follow_emergency(Assembly& assembly);
  void follow_processes(Assembly& assembly, UpperLayers& upper);

  SimulatedClock clock_;
  std::mt19937_64 random_;
  std::vector<std::uint32_t> ready_;
  std::vector<bool> is_ready_, has_ended_;
  std::optional<std::uint32_t> unfinished_;  // has fired, and its turn has not ended
  std::unique_ptr<RemoteControl> remote_;    // only for a run that is watched
  std::optional<Duration> skip_to_;          // until the run has reached it
  DeadlineQueue deadlines_, beats_;
  ProcessLives lives_;
  Time last_firing_{};
  EmergencyWatch emergencies_;
  std::vector<std::uint64_t> firings_at_scenario_end_;  // per instance; empty: no scenario
  RunSummary::Failure world_failure_ = RunSummary::Failure::none;
  StuckWatch stuck_;
  std::optional<CallWatch> calls_;
  std::optional<PublishedClock> published_;
  std::optional<Monitor> monitor_;  // the last member: it looks at the others
};

}  // namespace tessera
