// Subsystems that receive first: an iteration begins at the instant of the rate, receives, calls its transition
// function with what it has received, sends, and evaluates its conditions.
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

[[nodiscard]] double milliseconds(Time time) { return seconds(time.time_since_epoch()) * 1e3; }

/// Sends the time of its call, in milliseconds.
[[nodiscard]] Script sends_the_time() {
  Script script;
  script.call = [](ScriptState& state) { state.out_x = milliseconds(state.context.now); };
  return script;
}

/// The values with which a receiver computes, and when.
struct SeenByReceiver {
  std::vector<double> at, value;
  [[nodiscard]] Script script() {
    Script script;
    script.call = [this](ScriptState& state) {
      at.push_back(milliseconds(state.context.now));
      value.push_back(state.x);
    };
    return script;
  }
};

/// A sender at 10 ms, and a receiver.
[[nodiscard]] SeenByReceiver seen_by(const SubsystemNet& receiver, Duration period,
                                     const SubsystemNet& sender, std::span<const FusedPlace> channel,
                                     Duration sender_period, Duration duration) {
  TestSystem system;
  SeenByReceiver seen;
  const auto a = system.add("robot.a", sender, sends_the_time(), sender_period);
  const auto b = system.add("robot.b", receiver, seen.script(), period);
  system.connect(a, "x", b, "x", channel);
  RunOptions options = simulated(duration);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_FALSE(summary.failed) << summary.ended;
  EXPECT_EQ(summary.subsystems.at(1).overruns, 0U);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  EXPECT_TRUE(recording) << error;
  if (recording) {
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
  }
  return seen;
}

TEST(ReceiveFirst, TheFunctionComputesWithTheNewestValueAndElseWithOneThatIsAPeriodOld) {
  const SeenByReceiver last =
      seen_by(nets::async_receiver, 32ms, nets::async_sender, asynchronous, 10ms, 150ms);
  const SeenByReceiver first =
      seen_by(nets::first_async_receiver, 32ms, nets::async_sender, asynchronous, 10ms, 150ms);
  EXPECT_EQ(first.at, (std::vector<double>{0, 32, 64, 96, 128}));
  EXPECT_EQ(first.at, last.at);
  EXPECT_EQ(first.value, (std::vector<double>{0, 30, 60, 90, 120}));
  EXPECT_EQ(last.value, (std::vector<double>{0, 0, 30, 60, 90}));
}

TEST(ReceiveFirst, ABlockingReceiveIsFollowedByTheCallAtOnce) {
  const SeenByReceiver paced = seen_by(nets::first_b_receiver, 0ms, nets::nb_sender, buffered, 50ms, 130ms);
  EXPECT_EQ(paced.at, (std::vector<double>{0, 50, 100}));
  EXPECT_EQ(paced.value, paced.at);
  // With a rate, the instants are those at which it begins to wait, and waiting is no overrun.
  const SeenByReceiver rated = seen_by(nets::first_b_receiver, 20ms, nets::nb_sender, buffered, 50ms, 230ms);
  EXPECT_EQ(rated.at, (std::vector<double>{0, 50, 100, 150, 200}));
  EXPECT_EQ(rated.value, rated.at);
  const SeenByReceiver slower = seen_by(nets::first_b_receiver, 70ms, nets::nb_sender, buffered, 50ms, 230ms);
  EXPECT_EQ(slower.at, (std::vector<double>{0, 70, 140, 210}));
  EXPECT_EQ(slower.value, (std::vector<double>{0, 50, 100, 200}));
}

TEST(ReceiveFirst, ATimeoutIsSeenInItsIteration) {
  TestSystem system;
  std::vector<std::pair<double, bool>> seen;
  Script receiver;
  receiver.call = [&](ScriptState& state) {
    seen.emplace_back(milliseconds(state.context.now), state.x.timed_out);
  };
  const auto a = system.add("robot.a", nets::nb_sender, sends_the_time(), 100ms);
  const auto b = system.add("robot.b", nets::first_b_receiver_timed, receiver, 0ms);
  system.connect(a, "x", b, "x", buffered, 0ms, 40ms);
  EXPECT_FALSE(run(system, simulated(150ms)).failed);
  EXPECT_EQ(seen, (std::vector<std::pair<double, bool>>{
                      {0, false}, {40, true}, {80, true}, {100, false}, {140, true}}));
}

/// Also in the conditions of an iteration, which sees each value once.
TEST(ReceiveFirst, ConditionsSeeWhatTheFunctionSaw) {
  TestSystem system;
  std::vector<bool> called, decided, fresh;
  std::vector<double> values, values_decided;
  Script receiver;
  receiver.call = [&](ScriptState& state) {
    called.push_back(state.x.fresh);
    values.push_back(state.x);
  };
  receiver.decide = [&](const ScriptState& state) {
    decided.push_back(state.x.fresh);
    values_decided.push_back(state.x);
    return Outcome::go_on;
  };
  const auto a = system.add("robot.a", nets::async_sender, sends_the_time(), 30ms);
  const auto b = system.add("robot.b", nets::first_async_receiver, receiver, 16ms);
  system.connect(a, "x", b, "x", asynchronous);
  EXPECT_FALSE(run(system, simulated(100ms)).failed);
  EXPECT_EQ(decided, called);
  EXPECT_EQ(values_decided, values);
  called.erase(called.begin());  // both begin at 0
  EXPECT_EQ(called, (std::vector<bool>{false, true, false, true, false, true}));
}

TEST(ReceiveFirst, IterationsAndTimesInABehaviourAreThoseOfTheOtherOrder) {
  const auto times = [](const SubsystemNet& net) {
    TestSystem system;
    std::vector<std::pair<std::uint64_t, Duration>> seen;
    Script script;
    script.call = [&](ScriptState& state) {
      seen.emplace_back(state.context.iteration, state.context.in_behaviour);
    };
    script.decide = [&](const ScriptState& state) {
      return state.context.in_behaviour >= 20ms ? Outcome::terminal : Outcome::go_on;
    };
    system.add("robot.a", net, script, 10ms);
    EXPECT_FALSE(run(system, simulated(75ms)).failed);
    return seen;
  };
  EXPECT_EQ(times(nets::first_two_behaviours).size(), 8U);
  EXPECT_EQ(times(nets::first_two_behaviours), times(nets::two_behaviours));
}

constexpr Behaviour slow_to_calculate[] = {{"run", 15ms}}, late_to_send[] = {{"run", 30ms}};

/// A behaviour that waits for its first value has not begun: `elapsed` is zero in its first call.
TEST(ReceiveFirst, ABehaviourBeginsWithItsFirstCall) {
  TestSystem system;
  std::vector<std::pair<double, Duration>> called;
  Script receiver;
  receiver.call = [&](ScriptState& state) {
    called.emplace_back(milliseconds(state.context.now), state.context.in_behaviour);
  };
  const SubsystemNet late{late_to_send, nets::nb_sender.ports, nets::nb_sender.places,
                          nets::nb_sender.transitions};
  const auto a = system.add("robot.a", late, sends_the_time(), 50ms);
  const auto b = system.add("robot.b", nets::first_b_receiver, receiver, 20ms);
  system.connect(a, "x", b, "x", buffered);
  EXPECT_FALSE(run(system, simulated(140ms)).failed);
  EXPECT_EQ(called, (std::vector<std::pair<double, Duration>>{{30, 0ms}, {80, 50ms}, {130, 100ms}}));
}

TEST(ReceiveFirst, WorkThatTakesTooLongMissesInstantsAsInTheOtherOrder) {
  for (const Overrun overrun : {Overrun::skip, Overrun::catch_up, Overrun::fault}) {
    const auto calls = [&](const SubsystemNet& net) {
      TestSystem system;
      SeenByReceiver seen;
      const SubsystemNet slow{slow_to_calculate, net.ports, net.places, net.transitions};
      const auto a = system.add("robot.a", nets::async_sender, sends_the_time(), 10ms);
      const auto b =
          system.add("robot.b", slow, seen.script(), 10ms, 0ms, Kind::control, {.overrun = overrun});
      const auto c = system.add("robot.c", nets::async_receiver, {}, 10ms);
      system.connect(a, "x", b, "in", asynchronous);
      system.connect(b, "out", c, "x", asynchronous);
      const RunSummary summary = run(system, simulated(100ms));
      return std::pair(seen.at, summary.subsystems.at(1).overruns);
    };
    const auto first = calls(nets::first_relay);
    EXPECT_GT(first.second, 2U);
    if (overrun == Overrun::fault)
      continue;  // an iteration that fails has no call; the relays end differently
    EXPECT_EQ(first, calls(nets::async_relay));
  }
}

TEST(ReceiveFirst, AFailureSendsInvalidValuesAndEndsByT6) {
  TestSystem system;
  std::vector<bool> valid;
  std::vector<bool> failures;
  Script relay = sends_the_time(), sink;
  relay.call = [](ScriptState& state) {
    state.out_x = 1;
    if (state.context.iteration == 2) throw std::runtime_error("oops");
  };
  relay.route = [&](const ScriptState&, bool failed) { return failures.push_back(failed), 0; };
  sink.call = [&](ScriptState& state) { valid.push_back(state.x.valid); };
  const auto a = system.add("robot.a", nets::async_sender, sends_the_time(), 10ms);
  const auto b = system.add("robot.b", nets::first_relay, relay, 10ms);
  const auto c = system.add("robot.c", nets::first_async_receiver, sink, 13ms);
  system.connect(a, "x", b, "in", asynchronous);
  system.connect(b, "out", c, "x", asynchronous);
  RunOptions options = simulated(50ms);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_FALSE(summary.failed) << summary.ended;
  EXPECT_EQ(failures, std::vector<bool>{true});
  ASSERT_EQ(valid.size(), 4U);  // at 0, 13, 26 and 39 ms
  EXPECT_EQ((std::vector<bool>{valid[1], valid[2], valid[3]}), (std::vector<bool>{true, false, true}));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
}

/// A motor that sends on what it received; the times and commands, without the safe ones.
struct CommandedMotor {
  std::vector<std::pair<double, double>> commands;
  std::vector<std::string> safe;
  explicit CommandedMotor(const SubsystemNet& net, Duration stale = 0ms) {
    TestSystem system;
    double now = 0;
    Script control, motor;
    control.call = [&](ScriptState& state) {
      state.out_x = milliseconds(state.context.now);
      if (state.context.iteration < 2 || state.context.iteration > 5) throw std::runtime_error("nothing");
    };
    motor.acts = true;
    motor.call = [&](ScriptState& state) {
      now = milliseconds(state.context.now);
      state.command = state.x.value();
    };
    system.devices.accept = [&](double value) {
      if (value >= 0) commands.emplace_back(now, value);
      return true;
    };
    const auto a = system.add("robot.control", nets::nb_sender_persistent, control, 10ms);
    const auto b = system.add("robot.motor", net, motor, 0ms, stale, Kind::effector);
    system.connect(a, "x", b, "x", buffered);
    RunOptions options = simulated(200ms);
    options.recording = scratch_file("run");
    EXPECT_FALSE(run(system, options).failed);
    std::string error;
    const auto recording = read_recording(options.recording, error);
    EXPECT_TRUE(recording) << error;
    if (recording)
      for (const auto& [event, text] : recording->entries)
        if (event.kind() == Event::Kind::safe) safe.push_back(text);
  }
};

TEST(ReceiveFirst, ACommandGoesOutInTheIterationInWhichItCame) {
  const std::vector<std::pair<double, double>> valid_ones{{20, 20}, {30, 30}, {40, 40}, {50, 50}};
  const CommandedMotor motor(nets::first_b_receiver);
  ASSERT_GE(motor.commands.size(), 4U);
  EXPECT_EQ(std::vector(motor.commands.begin(), motor.commands.begin() + 4), valid_ones);
}

TEST(ReceiveFirst, SafeCommandsStandUntilTheFirstValidValueAndWhenValuesAreStale) {
  const CommandedMotor motor(nets::first_b_receiver, 35ms);
  ASSERT_GE(motor.safe.size(), 3U);
  EXPECT_EQ(motor.safe[0], "robot.motor.command: safe command: no valid value has come to input 'x' yet");
  EXPECT_EQ(motor.safe[1], "robot.motor.command: commands go to it again");
  EXPECT_EQ(motor.safe[2].find("robot.motor.command: safe command: "), 0U);
  EXPECT_NE(motor.safe[2].find("'x'"), std::string::npos) << motor.safe[2];
  EXPECT_NE(motor.safe[2].find("stale"), std::string::npos) << motor.safe[2];
}

/// A receptor, a control and a motor, the last two receiving first.
[[nodiscard]] const System& robot_that_receives_first(TestSystem& system, std::uint64_t& readings) {
  system.devices.sense = [&readings](double& value) {
    value = static_cast<double>(readings * readings % 7);
    return ++readings % 5 != 0;
  };
  Script sensor, control, motor;
  sensor.senses = true;
  sensor.call = [](ScriptState& state) { state.out_x = state.sensed * (state.sensed.fresh ? 2 : 1); };
  control.call = [sum = 0.0](ScriptState& state) mutable {
    if (state.context.iteration == 20) throw std::runtime_error("oops");
    sum += state.x * (state.x.fresh ? 1 : 10);
    state.out_x = sum + seconds(state.x.age) + static_cast<double>(state.context.iteration);
  };
  control.decide = [](const ScriptState& state) {
    return state.x.fresh && state.x > 5 ? Outcome::terminal : Outcome::go_on;
  };
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = -state.x; };
  const auto s = system.add("robot.sensor", nets::async_sender, sensor, 10ms, 0ms, Kind::receptor);
  const auto c = system.add("robot.control", nets::first_relay, control, 7ms);
  const auto m = system.add("robot.motor", nets::first_async_receiver, motor, 4ms, 50ms, Kind::effector);
  system.connect(s, "x", c, "in", asynchronous);
  system.connect(c, "out", m, "x", asynchronous);
  return system.system();
}

TEST(ReceiveFirst, TheSameCodeDoesTheSameAgainOnARecording) {
  for (const bool threads : {false, true}) {
    RunOptions options = threads ? steady(300ms) : simulated(500ms);
    options.recording = scratch_file("run");
    {
      TestSystem system;
      std::uint64_t readings = 0;
      static_cast<void>(robot_that_receives_first(system, readings));
      EXPECT_FALSE(run(system, options).failed);
      std::string error;
      const auto recording = read_recording(options.recording, error);
      ASSERT_TRUE(recording) << error;
      EXPECT_EQ(complaint_about(*recording, system.system()), "");
    }
    TestSystem system;
    std::uint64_t readings = 0;
    std::string error;
    const auto report = rerun(robot_that_receives_first(system, readings), {}, options.recording, error);
    ASSERT_TRUE(report) << error;
    EXPECT_FALSE(report->first) << rerun_text(*report);
    if (!threads) {
      EXPECT_EQ(report->subsystems.at(1).iterations, 72U);
    }
  }
}

TEST(ReceiveFirst, AScenarioIsFollowed) {
  TestSystem system;
  std::vector<double> at;
  Script script;
  script.call = [&](ScriptState& state) { at.push_back(milliseconds(state.context.now)); };
  system.add("robot.a", nets::first_two_behaviours, script, 10ms);
  std::string text = R"({"scenario": 1, "net_hash": ")" + std::string(system.system().net_hash) +
                     R"(", "firings": ["t_in", "robot.t_in", "robot.a.t_in")";
  for (const char* one : {"first.t1", "first.rcv.t1", "first.t2", "first.t3", "first.snd.t1", "first.t4",
                          "first.t1", "first.rcv.t1", "first.t2", "first.t3", "first.snd.t1", "first.t6",
                          "t_first_0", "second.t1", "second.rcv.t1"})
    text += std::string(", \"robot.a.") + one + '"';
  RunOptions options = simulated(5ms);
  options.scenario = scratch_file("scenario.json");
  options.recording = scratch_file("run");
  std::ofstream(options.scenario) << text << "]}";
  EXPECT_EQ(run(system, options).ended, "duration");
  EXPECT_EQ(at, (std::vector<double>{0, 10, 20}));  // the last one in the time after the scenario
}

}  // namespace
}  // namespace tessera::testing
