#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/effectors.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

[[nodiscard]] Script driver(double safe = -1) {
  Script script;
  script.acts = true;
  script.safe = safe;
  script.call = [](ScriptState& state) { state.command = 5; };
  return script;
}

/// In the order of their times: several threads may have written them.
[[nodiscard]] std::vector<std::string> safe_events(const std::string& file) {
  std::string error;
  auto recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  std::vector<std::string> texts;
  if (recording)
    std::ranges::stable_sort(recording->entries, {},
                             [](const Recording::Entry& entry) { return entry.event.time_ns; });
  if (recording)
    for (const auto& [event, text] : recording->entries)
      if (event.kind() == Event::Kind::safe) texts.push_back(text);
  return texts;
}

constexpr std::array clocks{RunOptions::Clock::simulated, RunOptions::Clock::steady};

TEST(SafeCommand, IsTriedAgainUntilTheDeviceTakesIt) {
  for (const RunOptions::Clock clock : clocks) {
    TestSystem system;
    int refusals = 5;
    system.devices.accept = [&](double value) { return value != -1 || --refusals < 0; };
    system.add("robot.motor", nets::alone, driver(), 1ms, 0ms, Kind::effector);
    RunOptions options = simulated(5ms);
    options.clock = clock;
    options.recording = scratch_file("run");
    const RunSummary summary = run(system, options);
    EXPECT_FALSE(summary.failed);
    EXPECT_LE(refusals, -1) << "six times at least";
    EXPECT_EQ(system.devices.commands.back(), -1);
    EXPECT_EQ(safe_events(options.recording),
              (std::vector<std::string>{"robot.motor.command: refuses its safe command",
                                        "robot.motor.command: safe command: the end"}));
  }
}

TEST(SafeCommand, ThatIsNeverTakenFailsTheRunAndHoldsUpNobody) {
  for (const RunOptions::Clock clock : clocks) {
    TestSystem system;
    std::atomic<int> refusals{0}, refusals_before_other{-1};
    system.devices.accept = [&](double value) {
      if (value == -1) ++refusals;
      int none = -1;
      if (value == -2) refusals_before_other.compare_exchange_strong(none, refusals);
      return value != -1;
    };
    system.add("robot.bad", nets::alone, driver(-1), 1ms, 0ms, Kind::effector);
    system.add("robot.good", nets::alone, driver(-2), 1ms, 0ms, Kind::effector);
    RunOptions options = simulated(5ms);
    options.clock = clock;
    const RunSummary summary = run(system, options);
    EXPECT_TRUE(summary.failed);
    EXPECT_EQ(summary.ended, "duration; robot.bad.command has not taken its safe command");
    ASSERT_GE(refusals_before_other, 0);
    EXPECT_LT(refusals_before_other, refusals) << "it has not waited until the bad one was given up";
  }
}

TEST(SafeCommand, ThatIsRefusedWhileTheRunGoesOnStopsIt) {
  TestSystem system;
  Script script = driver();
  script.call = [](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 2) throw std::runtime_error("oops");
  };
  script.route = [](const ScriptState&, bool) { return 0; };
  system.devices.accept = [](double value) { return value != -1; };
  system.add("robot.motor", nets::two_behaviours, script, 10s, 0ms, Kind::effector);
  const RunSummary summary = run(system, simulated(1h));
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended,
            "stopped: robot.motor: a real effector refuses its safe command; robot.motor.command has not "
            "taken its safe command");
  EXPECT_LT(summary.simulated, 30s) << "a second after the first that it refused";
}

TEST(SafeCommand, ReachesTheOtherDevicesWhenADriverDoesNotReturn) {
  struct Stuck final : RealEffector {
    std::atomic<bool> entered{false}, go_on{false};
    bool write(std::span<const std::byte>) override {
      entered = true;
      while (!go_on) std::this_thread::yield();
      return true;
    }
  };
  struct Fine final : RealEffector {
    std::atomic<int> writes{0};
    bool write(std::span<const std::byte>) override {
      ++writes;
      return true;
    }
  };
  Bindings bindings;
  Output<double> out_first, out_second;
  bindings.real_output("first", out_first, -1.0);
  bindings.real_output("second", out_second, -1.0);
  std::vector<std::unique_ptr<RealEffector>> drivers;
  auto stuck = std::make_unique<Stuck>();
  auto fine = std::make_unique<Fine>();
  Stuck& its_stuck = *stuck;
  Fine& its_fine = *fine;
  drivers.push_back(std::move(stuck));
  drivers.push_back(std::move(fine));
  RunControl control(1);
  SteadyClock clock;
  Effectors effectors({{"robot.motor.first", 0, 1}, {"robot.motor.second", 1, 1}}, drivers,
                      bindings.real_outputs, control, clock);
  std::thread own([&] { static_cast<void>(effectors.command(clock.now(), control.interruptions())); });
  while (!its_stuck.entered) std::this_thread::yield();
  EXPECT_FALSE(effectors.make_safe({SafeReason::Kind::leaves}, Effectors::Busy::leaves_out));
  EXPECT_EQ(its_fine.writes, 1);
  EXPECT_TRUE(effectors.owing());
  EXPECT_EQ(effectors.unsafe(), (std::vector<std::string>{"robot.motor.first"}));
  control.request_stop("enough", false);
  its_stuck.go_on = true;
  own.join();
  EXPECT_EQ(its_fine.writes, 1) << "no command after the safe one, since the run stops";
  EXPECT_TRUE(effectors.insist({SafeReason::Kind::leaves}, Effectors::Busy::waits));
  EXPECT_TRUE(effectors.unsafe().empty());
}

/// Nobody knows what the device does that does not take its safe command, so the others stand still, too. They go on
/// when it has taken it.
TEST(SafeCommand, IsOfAllDevicesWhileOneDoesNotTakeIt) {
  for (const bool hangs : {true, false}) {
    TestSystem system;
    std::atomic<bool> resists{false}, held{false}, drives_again{false};
    Script bad = driver(-1), good = driver(-2);
    bad.call = [&](ScriptState& state) {
      state.command = 5;
      if (held || state.context.iteration < 5) return;
      resists = true;
      if (!hangs) throw std::runtime_error("oops");
    };
    bad.route = [](const ScriptState&, bool) { return 0; };
    good.call = [&](ScriptState& state) {
      state.command = 6;
      if (drives_again) state.context.stop("enough");
    };
    good.route = bad.route;
    system.devices.accept = [&](double value) {
      if (value == -2 && resists) held = true;
      if (value == 6 && held) drives_again = true;
      if (!resists || held || value == 6) return true;
      if (!hangs) return false;
      while (value == 5 && !held) std::this_thread::sleep_for(1ms);
      return true;
    };
    Policies policies;
    policies.watchdog = 30ms;
    system.add("robot.bad", nets::two_behaviours, bad, 1ms, 0ms, Kind::effector, policies);
    system.add("robot.good", nets::two_behaviours, good, 1ms, 0ms, Kind::effector);
    RunOptions options = steady(1min);
    options.recording = scratch_file("run");
    EXPECT_EQ(run(system, options).ended, "stopped: enough")
        << (hangs ? "a driver hangs" : "a device refuses");
    EXPECT_TRUE(drives_again);
    const std::vector<std::string> events = safe_events(options.recording);
    EXPECT_GE(std::ranges::count(
                  events, "robot.good.command: safe command: another device does not take its safe command"),
              1);
  }
}

/// The subsystem's thread goes on before the supervisor knows that the guardian has acted.
TEST(SafeCommand, OfTheGuardianIsFollowedByNoOtherCommand) {
  struct Counted final : RealEffector {
    std::atomic<bool>* acted = nullptr;  // becomes true while a command is written
    std::vector<double> values;
    bool write(std::span<const std::byte> value) override {
      values.push_back(*reinterpret_cast<const double*>(value.data()));
      if (acted != nullptr) *acted = true;
      return true;
    }
  };
  std::atomic<bool> acted{false};
  Bindings bindings;
  Output<double> first, second;
  bindings.real_output("first", first, -1.0);
  bindings.real_output("second", second, -1.0);
  first = second = 5;
  std::vector<std::unique_ptr<RealEffector>> drivers;
  drivers.push_back(std::make_unique<Counted>());
  drivers.push_back(std::make_unique<Counted>());
  auto& its_first = static_cast<Counted&>(*drivers[0]);
  auto& its_second = static_cast<Counted&>(*drivers[1]);
  RunControl control(1);
  control.withhold_after(acted);
  SteadyClock clock;
  Effectors effectors({{"robot.motor.first", 0, 1}, {"robot.motor.second", 1, 1}}, drivers,
                      bindings.real_outputs, control, clock);
  EXPECT_EQ(effectors.command(clock.now(), control.interruptions()), Effectors::Answer::taken);
  its_second.acted = &acted;
  EXPECT_EQ(effectors.command(clock.now(), control.interruptions()), Effectors::Answer::withheld)
      << "the safe command must follow";
  EXPECT_EQ(effectors.command(clock.now(), control.interruptions()), Effectors::Answer::withheld);
  EXPECT_TRUE(effectors.make_safe({SafeReason::Kind::leaves}, Effectors::Busy::waits));
  EXPECT_EQ(its_first.values, (std::vector<double>{5, 5, -1}));
  EXPECT_EQ(its_second.values, its_first.values);
}

/// The subsystem's thread found its command good, and goes on when the interruption is over.
TEST(SafeCommand, OfAnInterruptionIsFollowedByNoCommandFromBeforeIt) {
  struct Written final : RealEffector {
    std::function<void()> during = [] {};
    std::vector<double> values;
    bool write(std::span<const std::byte> value) override {
      values.push_back(*reinterpret_cast<const double*>(value.data()));
      std::exchange(during, [] {})();
      return true;
    }
  };
  Bindings bindings;
  Output<double> command;
  bindings.real_output("command", command, -1.0);
  command = 5;
  std::vector<std::unique_ptr<RealEffector>> drivers;
  drivers.push_back(std::make_unique<Written>());
  auto& driver = static_cast<Written&>(*drivers[0]);
  RunControl control(1);
  SteadyClock clock;
  Effectors effectors({{"robot.motor", 0, 1}}, drivers, bindings.real_outputs, control, clock);
  struct Interruption {
    std::function<void()> begin, end;
  };
  const std::array<Interruption, 2> interruptions = {
      Interruption{[&] { control.suspend(); }, [&] { control.resume(clock.now()); }},
      Interruption{[&] { control.begin_emergency("a person"); },
                   [&] { control.end_emergency(clock.now()); }}};
  for (const Interruption& interruption : interruptions) {
    driver.values.clear();
    RunControl::Interruptions before = control.interruptions();
    interruption.begin();
    const RunControl::Interruptions meanwhile = control.interruptions();
    interruption.end();
    EXPECT_EQ(effectors.command(clock.now(), before), Effectors::Answer::withheld);
    EXPECT_EQ(effectors.command(clock.now(), meanwhile), Effectors::Answer::withheld);
    EXPECT_EQ(driver.values, std::vector<double>{});
    before = control.interruptions();
    driver.during = [&interruption] { interruption.begin(), interruption.end(); };
    EXPECT_EQ(effectors.command(clock.now(), before), Effectors::Answer::withheld)
        << "the safe command must follow";
    EXPECT_TRUE(effectors.owing());
    EXPECT_TRUE(effectors.make_safe({SafeReason::Kind::suspended}, Effectors::Busy::waits));
    EXPECT_EQ(effectors.command(clock.now(), control.interruptions()), Effectors::Answer::taken);
    EXPECT_EQ(driver.values, (std::vector<double>{5, -1, 5}));
  }
}

TEST(SafeCommand, StandsUntilEveryInputHasBeenValidOnce) {
  for (const RunOptions::Clock clock : clocks) {
    TestSystem system;
    Script control, motor = driver();
    std::atomic<bool> drove{false};
    system.devices.accept = [&](double value) {
      if (value == 107) drove = true;
      return true;
    };
    control.call = [&](ScriptState& state) {
      state.out_x = 7;
      if (state.context.iteration < 3) throw std::runtime_error("not yet");
      if (drove) state.context.stop("enough");
    };
    std::vector<double> seen;
    motor.call = [&](ScriptState& state) {
      seen.push_back(state.x.value());
      state.command = state.x.value() + 100;
    };
    const auto a = system.add("robot.control", nets::nb_sender_persistent, control, 2ms);
    const auto b = system.add("robot.motor", nets::nb_receiver, motor, 1ms, 0ms, Kind::effector);
    system.connect(a, "x", b, "x", buffered);
    RunOptions options = simulated(1min);
    options.clock = clock;
    options.recording = scratch_file("run");
    EXPECT_EQ(run(system, options).ended, "stopped: enough");
    ASSERT_GE(seen.size(), 2U);
    EXPECT_EQ(seen.front(), 0) << "the function runs";
    for (const double command : system.devices.commands)
      EXPECT_TRUE(command == -1 || command == 107) << command;
    EXPECT_EQ(system.devices.commands.front(), -1);
    const std::vector<std::string> events = safe_events(options.recording);
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0], "robot.motor.command: safe command: no valid value has come to input 'x' yet");
    EXPECT_EQ(events[1], "robot.motor.command: commands go to it again");
    EXPECT_EQ(events[2], "robot.motor.command: safe command: the end");
  }
}

TEST(SafeCommand, OfAFaultIsRecordedWithItsEnd) {
  TestSystem system;
  Script script = driver();
  script.call = [](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 1) throw std::runtime_error("oops");
  };
  script.route = [](const ScriptState&, bool) { return 0; };
  system.add("robot.motor", nets::two_behaviours, script, 10ms, 0ms, Kind::effector);
  RunOptions options = simulated(25ms);
  options.recording = scratch_file("run");
  EXPECT_FALSE(run(system, options).failed);
  EXPECT_EQ(safe_events(options.recording),
            (std::vector<std::string>{"robot.motor.command: safe command: a fault",
                                      "robot.motor.command: commands go to it again",
                                      "robot.motor.command: safe command: the end"}));
}

/// Standard error is a full pipe that is not read.
class FullPipe {
 public:
  FullPipe() {
    EXPECT_EQ(pipe(ends_.data()), 0);
    fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    const std::array<char, 4096> bytes{};
    while (write(ends_[1], bytes.data(), bytes.size()) > 0) continue;
    while (write(ends_[1], bytes.data(), 1) > 0) continue;
    fcntl(ends_[1], F_SETFL, 0);
    before_ = dup(STDERR_FILENO);
    dup2(ends_[1], STDERR_FILENO);
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  ~FullPipe() {
    dup2(before_, STDERR_FILENO);
    for (const int descriptor : {before_, ends_[0], ends_[1]}) close(descriptor);
  }

 private:
  std::array<int, 2> ends_{};
  int before_ = -1;
};

TEST(BlockedTerminal, HoldsUpNeitherWatchdogNorStaleNorTheEnd) {
  TestSystem system;
  std::atomic<bool> motor_goes{false}, arm_goes{false}, safe_by_watchdog{false}, safe_by_stale{false};
  const auto give_up = std::chrono::steady_clock::now() + 50s;
  Script motor = driver(-1), control, arm = driver(-2);
  motor.call = [&](ScriptState& state) {
    state.command = 5;
    for (int line = 0; line < 100; ++line) state.context.log("line {}", line);
    if (state.context.iteration == 3)
      while ((!safe_by_watchdog || !safe_by_stale) && std::chrono::steady_clock::now() < give_up)
        std::this_thread::yield();
    if (state.context.iteration == 4) state.context.stop("enough");
  };
  motor.route = [](const ScriptState&, bool) { return 0; };
  control.call = [&](ScriptState&) {
    // Not after a fixed time: on a busy machine, the arm may not have been commanded by then.
    if (arm_goes) throw std::runtime_error("blind");
  };
  arm.call = [](ScriptState& state) { state.command = 6; };
  system.devices.accept = [&](double value) {
    if (value == 5) motor_goes = true;
    if (value == 6) arm_goes = true;
    if (value == -1 && motor_goes) safe_by_watchdog = true;
    if (value == -2 && arm_goes) safe_by_stale = true;
    return true;
  };
  Policies policies;
  policies.watchdog = 20ms;
  system.add("robot.motor", nets::two_behaviours, motor, 1ms, 0ms, Kind::effector, policies);
  const auto a = system.add("robot.control", nets::nb_sender_persistent, control, 2ms);
  const auto b = system.add("robot.arm", nets::b_receiver, arm, 0ms, 20ms, Kind::effector);
  system.connect(a, "x", b, "x", buffered);
  RunSummary summary;
  {
    const FullPipe nobody_reads;
    RunOptions options = steady(1min);
    options.progress = true;
    summary = run(system, options);
  }
  EXPECT_TRUE(safe_by_watchdog);
  EXPECT_TRUE(safe_by_stale);
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_GT(summary.lines_not_printed, 100U);
}

}  // namespace
}  // namespace tessera::testing
