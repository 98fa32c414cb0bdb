#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "../environment.hpp"
#include "firing_oracle.hpp"
#include "nets.hpp"
#include "system/console.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A fault of a recording: when, of which class, and its text.
using Recorded = std::tuple<Duration, Fault, std::string>;

[[nodiscard]] std::vector<Recorded> faults_in(const std::string& file) {
  std::string error;
  const auto recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  std::vector<Recorded> faults;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::fault) faults.emplace_back(Duration(event.time_ns), event.fault(), text);
  return faults;
}

/// One subsystem whose errors lead from behaviour `first` to `second`, and `second` back.
struct Routed : ::testing::Test {
  TestSystem system;
  std::vector<std::uint16_t> behaviours;
  RunOptions options = simulated(45ms);

  Script script() {
    Script one;
    one.call = [this](ScriptState& state) {
      behaviours.push_back(state.behaviour);
      state.out_x = 3;
      state.command = 5;
    };
    one.decide = [](const ScriptState& state) {
      return state.behaviour == 1 ? Outcome::terminal : Outcome::go_on;
    };
    return one;
  }
  void add(Script one, Policies policies = {}) {
    const Kind kind = one.acts ? Kind::effector : one.senses ? Kind::receptor : Kind::control;
    system.add("robot.a", nets::two_behaviours, std::move(one), 10ms, 0ms, kind, policies);
  }
  /// Runs it with that fault, and returns the entries of the recording about it; the run must be legal.
  std::vector<Recorded> run_with(const std::string& fault) {
    options.inject = {fault};
    options.recording = scratch_file("run");
    const RunSummary summary = run(system, options);
    EXPECT_FALSE(summary.failed) << summary.ended;
    EXPECT_EQ(summary.subsystems.at(0).errors, expected_errors);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    EXPECT_TRUE(recording) << error;
    EXPECT_EQ(recording ? complaint_about(*recording, system.system()) : "", "");
    return faults_in(options.recording);
  }
  std::uint64_t expected_errors = 1;
};

const std::vector<std::uint16_t> routed_after_three{0, 0, 1, 0};  // the failed call was the user's no more

TEST_F(Routed, AnExceptionLeadsToTheBehaviourItIsRoutedTo) {
  add(script());
  EXPECT_EQ(run_with("robot.a.first:throw@15ms"),
            (std::vector<Recorded>{{20ms, Fault::exception, "robot.a.first.in: injected"}}));
  EXPECT_EQ(behaviours, routed_after_three);
}

TEST_F(Routed, AnOutputThatIsNotFiniteIsAnError) {
  for (const char* fault : {"robot.a:nan@20ms", "robot.a:inf@20ms"}) {
    TestSystem fresh;
    behaviours.clear();
    fresh.add("robot.a", nets::two_behaviours, script(), 10ms);
    options.inject = {fault};
    options.recording = scratch_file("run");
    EXPECT_EQ(run(fresh, options).subsystems.at(0).errors, 1U);
    EXPECT_EQ(
        faults_in(options.recording),
        (std::vector<Recorded>{{20ms, Fault::not_finite, "robot.a.first.in: output 'x' is not finite"}}));
    EXPECT_EQ(behaviours, (std::vector<std::uint16_t>{0, 0, 0, 1, 0}));
  }
}

TEST_F(Routed, AnOutputMayBeInfiniteWhereThatIsAllowed) {
  Policies policies;
  policies.non_finite_allowed = true;
  add(script(), policies);
  expected_errors = 0;
  EXPECT_EQ(run_with("robot.a:inf@20ms.."), std::vector<Recorded>{});
}

TEST_F(Routed, AStallBeyondTheWatchdogIsToldAtOnceAndAnErrorWhenItReturns) {
  Policies policies;
  policies.watchdog = 5ms;
  Script motor = script();
  motor.acts = true;
  add(std::move(motor), policies);
  EXPECT_EQ(run_with("robot.a:stall=12ms@10ms"),
            (std::vector<Recorded>{
                {15ms + 1ns, Fault::stall,
                 "robot.a.first.in: has not returned for 0.005 s; the devices get the safe command"},
                {22ms, Fault::stall,
                 "robot.a.first.in: took 0.012 s, and its watchdog allows 0.005 s; the devices get the safe "
                 "command"}}));
  EXPECT_EQ(behaviours, (std::vector<std::uint16_t>{0, 0, 1, 0}));
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, -1, -1, 5, 5, -1}));
}

TEST_F(Routed, ADeviceThatRefusesIsAnErrorAndGetsTheSafeCommand) {
  Script motor = script();
  motor.acts = true;
  add(std::move(motor));
  EXPECT_EQ(run_with("device:robot.a@10ms"),
            (std::vector<Recorded>{{10ms, Fault::device,
                                    "robot.a.first.in: robot.a.command: the device refused its command; "
                                    "the devices get the safe command"}}));
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, -1, 5, 5, 5, -1}));
}

TEST_F(Routed, AReceptorThatFailsIsAnError) {
  Script eye = script();
  eye.senses = true;
  add(std::move(eye));
  EXPECT_EQ(run_with("device:robot.a.sensed@10ms"),
            (std::vector<Recorded>{{10ms, Fault::device,
                                    "robot.a.first.in: reading a real receptor: injected: "
                                    "device:robot.a.sensed@10ms"}}));
}

TEST_F(Routed, ASilentReceptorIsNoErrorButNotFresh) {
  std::vector<bool> fresh;
  Script eye = script();
  eye.senses = true;
  eye.call = [&](ScriptState& state) { fresh.push_back(state.sensed.fresh); };
  add(std::move(eye));
  expected_errors = 0;
  EXPECT_EQ(run_with("silent:robot.a@10ms..30ms"), std::vector<Recorded>{});
  EXPECT_EQ(fresh, (std::vector<bool>{true, false, false, true, true}));
}

TEST_F(Routed, ASignalEndsTheRunWithTheSafeCommand) {
  for (const char* signal : {"SIGINT", "SIGTERM", "SIGHUP", "SIGALRM"}) {
    TestSystem fresh;
    Script motor = script();
    motor.acts = true;
    fresh.add("robot.a", nets::two_behaviours, motor, 10ms, 0ms, Kind::effector);
    options.inject = {std::string("signal:") + signal + "@25ms"};
    const RunSummary summary = run(fresh, options);
    EXPECT_EQ(summary.ended, signal);
    EXPECT_EQ(summary.simulated, 25ms);
    EXPECT_EQ(fresh.devices.commands, (std::vector<double>{5, 5, 5, -1}));
  }
}

TEST_F(Routed, TheTimeOfAFaultMayBeDrawnFromTheSeed) {
  add(script());
  options.duration = 1s;
  std::vector<Duration> times;
  for (options.seed = 1; options.seed <= 20; ++options.seed)
    for (const auto& [at, fault, text] : run_with("robot.a:throw@any")) times.push_back(at);
  EXPECT_GT(std::ranges::max(times), std::ranges::min(times));
}

/// control -> motor, which goes on without new values.
struct Pair : ::testing::Test {
  TestSystem system;
  RunOptions options = simulated(95ms);
  void add(Policies of_control, Duration stale) {
    Script control, motor;
    control.route = [](const ScriptState&, bool) { return 0; };
    control.call = [](ScriptState& state) { state.out_x = 7; };
    motor.acts = true;
    motor.call = [](ScriptState& state) { state.command = state.x.value(); };
    const auto a = system.add("robot.control", nets::nb_sender_persistent, control, 10ms, 0ms, Kind::control,
                              of_control);
    const auto b = system.add("robot.motor", nets::nb_receiver, motor, 10ms, stale, Kind::effector);
    system.connect(a, "x", b, "x", buffered);
    options.recording = scratch_file("run");
  }
};

TEST_F(Pair, AStaleInputIsAFaultOfTheEffectorAndEndsByItself) {
  add({}, 25ms);
  options.inject = {"robot.control:stall=45ms@10ms"};
  EXPECT_FALSE(run(system, options).failed);
  const auto faults = faults_in(options.recording);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(std::get<1>(faults[0]), Fault::stale);
  EXPECT_NE(std::get<2>(faults[0]).find(
                "input 'x' has had no valid value for 0.025 s; the devices get the safe command"),
            std::string::npos)
      << std::get<2>(faults[0]);
  const auto& commands = system.devices.commands;
  const auto held = std::find(commands.begin(), commands.end(), -1);
  EXPECT_NE(std::find(held, commands.end(), 7), commands.end()) << "it goes on when values come again";
}

TEST_F(Pair, WhileTheSourceStallsTheEffectorGetsTheSafeCommandAtOnce) {
  Policies policies;
  policies.watchdog = 3ms;
  add(policies, 0ms);
  options.inject = {"robot.control:stall=45ms@20ms"};
  EXPECT_FALSE(run(system, options).failed);
  const auto faults = faults_in(options.recording);
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(std::get<1>(faults[0]), Fault::stall);
  EXPECT_EQ(std::get<0>(faults[1]), 23ms + 1ns);
  EXPECT_EQ(std::get<1>(faults[1]), Fault::stale);
  EXPECT_NE(std::get<2>(faults[1]).find("the source of input 'x' stalls"), std::string::npos);
}

TEST_F(Routed, AnOverrunIsAnErrorWhereThatIsAskedFor) {
  Policies policies;
  policies.overrun = Overrun::fault;
  Script motor = script();
  motor.acts = true;
  add(std::move(motor), policies);
  EXPECT_EQ(run_with("robot.a:stall=12ms@10ms"),
            (std::vector<Recorded>{{30ms, Fault::overrun,
                                    "robot.a.first.in: its work made it miss 1 instant of its rate; the "
                                    "devices get the safe command"}}));
  // The function is not called at 30 ms.
  EXPECT_EQ(behaviours, (std::vector<std::uint16_t>{0, 0, 1}));
}

TEST(Overruns, AreLeftOutOrMadeUpForAndRecorded) {
  for (const Overrun overrun : {Overrun::skip, Overrun::catch_up}) {
    TestSystem system;
    std::vector<Duration> called;
    Script script;
    script.call = [&](ScriptState& state) { called.push_back(state.context.now.time_since_epoch()); };
    Policies policies;
    policies.overrun = overrun;
    system.add("robot.a", nets::alone, script, 10ms, 0ms, Kind::control, policies);
    RunOptions options = simulated(75ms);
    options.inject = {"robot.a:stall=35ms@20ms"};
    options.recording = scratch_file("run");
    EXPECT_EQ(run(system, options).subsystems.at(0).overruns, 3U);
    EXPECT_EQ(called, overrun == Overrun::skip
                          ? (std::vector<Duration>{0ms, 10ms, 20ms, 60ms, 70ms})
                          : (std::vector<Duration>{0ms, 10ms, 20ms, 55ms, 55ms, 55ms, 60ms, 70ms}));
    std::string error;
    const auto recording = read_recording(options.recording, error);
    ASSERT_TRUE(recording) << error;
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
    std::vector<std::pair<Duration, std::uint32_t>> recorded;
    for (const auto& [event, text] : recording->entries)
      if (event.kind() == Event::Kind::overrun) recorded.emplace_back(event.time_ns, event.subject);
    EXPECT_EQ(recorded, (std::vector<std::pair<Duration, std::uint32_t>>{{55ms, 3}}));
  }
}

TEST(Inject, SaysWhatIsWrong) {
  struct Case {
    const char* fault;
    const char* complaint;
  };
  for (const Case& one : {
           Case{"robot.a", "expected FAULT@WHEN, for example robot.control:throw@2.5s"},
           Case{"robot.b:throw@1s", "unknown 'robot.b'; did you mean 'robot.a'?"},
           Case{"robot.a.frist:throw@1s", "unknown 'robot.a.frist'; did you mean 'robot.a.first'?"},
           Case{"robot.a:trow@1s",
                "unknown fault 'trow'; there are throw, stall=TIME, nan, inf, and the prefixes device:, "
                "silent:, signal:, link:, process:; did you mean 'throw'?"},
           Case{"robot.a:stall@1s", "stall needs a time, for example stall=200ms"},
           Case{"robot.a:nan=3@1s", "'nan' takes no value"},
           Case{"robot.a:throw@soon", "'soon' is no time such as 2.5s or 200ms"},
           Case{"robot.a:throw@2s..1s", "'2s..1s' ends before it begins"},
           Case{"device:robot.a@1s", "'robot.a' has no such device"},
           Case{"signal:SIGKILL@1s", "'SIGKILL' is no signal that stops a run, such as SIGINT or SIGHUP"},
       }) {
    TestSystem system;
    system.add("robot.a", nets::two_behaviours, {}, 10ms);
    RunOptions options = simulated(10ms);
    options.inject = {one.fault};
    std::string error;
    EXPECT_FALSE(execute(system.system(), options, error)) << one.fault;
    EXPECT_EQ(error, std::string("--inject ") + one.fault + ": " + one.complaint);
  }
}

TEST_F(Routed, AFaultThatNeverHappensIsAWarning) {
  add({});  // stays in the first behaviour
  options.inject = {"robot.a.first:throw@15ms", "robot.a.second:stall=1ms@1ms", "signal:SIGINT@40ms",
                    "signal:SIGTERM@41ms"};
  const RunSummary summary = run(system, options);
  std::vector<bool> happened;
  for (const RunSummary::PlantedFault& fault : summary.injected) happened.push_back(fault.happened);
  EXPECT_EQ(happened, (std::vector<bool>{true, true, true, false})) << "the error leads to `second`";
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_EQ(summary.warnings[0],
            "the planted fault signal:SIGTERM@41ms never happened; this run does not show what it does");
  options.inject = {"robot.a.second:throw@any"};
  EXPECT_EQ(run(system, options).warnings.size(), 1U);
}

TEST_F(Routed, AFaultThatWouldComeAfterTheEndIsRefused) {
  add(script());
  for (const char* fault : {"robot.a:throw@45ms", "robot.a:stall=1ms@1s..", "signal:SIGINT@60ms"}) {
    options.inject = {fault};
    std::string error;
    EXPECT_FALSE(execute(system.system(), options, error)) << fault;
    EXPECT_EQ(error, std::string("--inject ") + fault +
                         ": the fault would never happen, because the run ends after 0.045 s");
  }
}

// --------------------------------------------------------------------------------------- line follower

/// The paper's example without its robot.
void make_line_follower(TestSystem& system) {
  Script sensor, control, motor;
  system.devices.sense = [](double& value) {
    value = 3;
    return true;
  };
  sensor.senses = true;
  sensor.call = [](ScriptState& state) { state.out_x = state.sensed.value(); };
  control.call = [](ScriptState& state) { state.out_x = 2 * state.x.value(); };
  control.decide = [](const ScriptState& state) {
    return state.behaviour == 0 ? Outcome::terminal : Outcome::go_on;
  };
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = state.x.value(); };
  Policies policies;
  policies.watchdog = 10ms;
  const auto c =
      system.add("robot.control", nets::paper_control, control, 50ms, 0ms, Kind::control, policies);
  const auto s = system.add("robot.sensor", nets::paper_sensor, sensor, 20ms, 0ms, Kind::receptor);
  const auto m = system.add("robot.motor", nets::paper_motor, motor, 20ms, 120ms, Kind::effector, policies);
  system.connect(s, "line", c, "line", asynchronous);
  system.connect(c, "motion", m, "velocity", buffered, 0ms, 200ms);
}

/// So many seeds of each fault; TESSERA_FAULT_SEEDS=1000 for the long form.
[[nodiscard]] std::uint64_t fault_seeds() { return from_environment("TESSERA_FAULT_SEEDS", share_of(20)); }

TEST(FaultClasses, OfTheLineFollowerAreRecordedAndEndInTheSafeCommand) {
  struct Case {
    const char* fault;
    std::optional<Fault> recorded;  ///< nullopt: the run ends by a signal
  };
  console::silence(true);
  for (const Case& one :
       {Case{"robot.control:throw", Fault::exception}, Case{"robot.control:nan", Fault::not_finite},
        Case{"robot.control:inf", Fault::not_finite}, Case{"robot.control:stall=300ms", Fault::stall},
        Case{"robot.control:stall=9ms", std::nullopt}, Case{"robot.sensor:throw", Fault::exception},
        Case{"robot.motor:throw", Fault::exception}, Case{"robot.motor:nan", Fault::not_finite},
        Case{"robot.motor:stall=300ms", Fault::stall}, Case{"device:robot.motor", Fault::device},
        Case{"device:robot.sensor", Fault::device}, Case{"signal:SIGINT", std::nullopt},
        Case{"signal:SIGTERM", std::nullopt}}) {
    for (std::uint64_t seed = 1; seed <= fault_seeds(); ++seed) {
      TestSystem system;
      make_line_follower(system);
      RunOptions options = simulated(1s);
      options.seed = seed;
      options.interleave = true;
      options.inject = {fmt::format("{}@{}ms", one.fault, seed * 7919 % 700)};
      options.recording = scratch_file("run");
      const RunSummary summary = run(system, options);
      ASSERT_EQ(system.devices.commands.back(), -1) << options.inject[0];
      const auto faults = faults_in(options.recording);
      if (!one.recorded) {
        EXPECT_TRUE(faults.empty()) << options.inject[0] << ": " << std::get<2>(faults[0]);
        continue;
      }
      ASSERT_FALSE(faults.empty()) << options.inject[0];
      EXPECT_EQ(std::get<1>(faults[0]), *one.recorded) << options.inject[0];
      const Duration at = std::get<0>(faults[0]);
      EXPECT_LE(at, Duration(std::chrono::milliseconds(seed * 7919 % 700)) + 310ms) << options.inject[0];
    }
  }
  console::silence(false);
}

// ------------------------------------------------------------------------------------------------ structures

struct Inner {
  float ratio;
  int count;
  friend auto tessera_fields_of(const Inner&) { return std::tuple(&Inner::ratio, &Inner::count); }
};
struct Outer {
  std::array<Inner, 2> inner;
  BoundedString<4> name;
  bool flag;
  friend auto tessera_fields_of(const Outer&) {
    return std::tuple(&Outer::inner, &Outer::name, &Outer::flag);
  }
};

TEST(Finite, LooksIntoStructuresAndArrays) {
  static_assert(has_floats<Outer>() && has_floats<std::array<float, 2>>());
  static_assert(!has_floats<std::array<std::uint8_t, 9>>() && !has_floats<BoundedString<4>>());
  Outer value{};
  EXPECT_TRUE(all_finite(value));
  value.inner[1].ratio = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(value));
  fill_floats(value, 2);
  EXPECT_EQ(value.inner[0].ratio, 2);
  EXPECT_TRUE(all_finite(value));
}

}  // namespace
}  // namespace tessera::testing
