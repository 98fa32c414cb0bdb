#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr int to_other = 0, to_end = 1;  // entries of `next` of nets::two_behaviours' first

/// An effector that drives forward with command 5 and whose safe command is -1.
[[nodiscard]] Script script_of_a_driver() {
  Script script;
  script.acts = true;
  script.call = [](ScriptState& state) { state.command = 5; };
  return script;
}

TEST(Failure, TextOfUserCodeDoesNotReachTheTerminalRaw) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState& state) {
    state.context.log("a\x1b[2Jb");
    throw std::runtime_error("with \x1b[31m and \x07, \xff: für");
  };
  system.add("robot.a", nets::alone, script, 1ms);
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(run(system, simulated(10ms)).failed);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("with \\x1b[31m and \\x07, \\xff: für"), std::string::npos) << said;
  EXPECT_NE(said.find("a\\x1b[2Jb"), std::string::npos) << said;
  EXPECT_EQ(said.find_first_of("\x1b\x07\xff"), std::string::npos) << said;
}

TEST(Failure, AnExceptionDiscardsTheOutputsAndTheReceiverKeepsTheLastValidOnes) {
  TestSystem system;
  std::vector<std::pair<double, bool>> seen;
  Script sender, receiver;
  sender.call = [](ScriptState& state) {
    state.out_x = static_cast<double>(state.context.iteration);
    if (state.context.iteration == 2) throw std::runtime_error("lost the line");
  };
  receiver.call = [&](ScriptState& state) {
    if (state.x.fresh || state.x.failed) seen.emplace_back(state.x.value(), state.x.valid);
  };
  const auto a = system.add("robot.a", nets::nb_sender_persistent, sender, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, receiver);
  system.connect(a, "x", b, "x", buffered);
  // 0 and 1 are fine; 2 fails, so an invalid value goes out. The error leads back to the behaviour.
  const RunSummary summary = run(system, simulated(35ms));
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(summary.subsystems.at(0).errors, 1u);
  EXPECT_EQ(seen, (std::vector<std::pair<double, bool>>{{0, true}, {1, true}, {1, false}, {3, true}}));
}

TEST(Failure, AnEntryOfNextThatTheNetLacksIsAFault) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  script.route = [](const ScriptState&, bool) { return 5; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  EXPECT_EQ(run(system, simulated(1s)).ended,
            "stopped: robot.a: what was decided has no transition: the generated code does not fit its net");
}

TEST(Failure, AnErrorMayBeRoutedToAnotherBehaviour) {
  TestSystem system;
  std::vector<std::uint16_t> behaviours;
  std::vector<bool> routed_as_error;
  Script script;
  script.call = [&](ScriptState& state) {
    behaviours.push_back(state.behaviour);
    if (state.context.iteration == 1) throw std::runtime_error("oops");
  };
  script.decide = [](const ScriptState& state) {
    return state.behaviour == 1 ? Outcome::terminal : Outcome::go_on;
  };
  script.route = [&](const ScriptState&, bool failed) {
    routed_as_error.push_back(failed);
    return to_other;
  };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  RunOptions options = simulated(45ms);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(behaviours, (std::vector<std::uint16_t>{0, 0, 1, 0, 0}));
  EXPECT_EQ(routed_as_error, (std::vector<bool>{true, false}));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  bool logged = false;
  for (const auto& entry : recording->entries)
    logged = logged || (entry.event.kind() == Event::Kind::fault && entry.text == "robot.a.first.in: oops" &&
                        entry.event.version == static_cast<std::uint32_t>(Fault::exception));
  EXPECT_TRUE(logged);
}

TEST(Failure, AnErrorNobodyRoutesStopsTheSystem) {
  for (const RunOptions::Clock clock : {RunOptions::Clock::simulated, RunOptions::Clock::steady}) {
    TestSystem system;
    Script script;
    script.decide = [](const ScriptState&) { return Outcome::error; };
    script.route = [](const ScriptState&, bool) { return to_end; };
    system.add("robot.a", nets::two_behaviours, script, 10ms);
    system.add("robot.motor", nets::alone, script_of_a_driver(), 1ms, 0ms, Kind::effector);
    RunOptions options = simulated(10s);
    options.clock = clock;
    const RunSummary summary = run(system, options);
    EXPECT_TRUE(summary.failed);
    EXPECT_EQ(summary.ended, "stopped: robot.a: ended by an error that no `next` leads to another behaviour");
    ASSERT_FALSE(system.devices.commands.empty());
    EXPECT_EQ(system.devices.commands.back(), -1);
  }
}

TEST(Failure, NoEntryOfNextIsAFault) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  script.route = [](const ScriptState&, bool) { return -1; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  EXPECT_EQ(run(system, simulated(1s)).ended, "stopped: robot.a: no condition of `next` holds");
}

TEST(Failure, AConditionOfNextThatThrowsIsAFault) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  script.route = [](const ScriptState&, bool) -> int { throw std::logic_error("no idea"); };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  const RunSummary summary = run(system, simulated(1s));
  EXPECT_EQ(summary.ended, "stopped: robot.a: a condition of `next` has thrown");
  EXPECT_TRUE(summary.failed);
}

TEST(Failure, AConditionThatThrowsIsAnError) {
  TestSystem system;
  std::vector<bool> as_error;
  Script script;
  script.decide = [](const ScriptState&) -> Outcome { throw std::logic_error("no idea"); };
  script.route = [&](const ScriptState&, bool failed) {
    as_error.push_back(failed);
    return to_other;
  };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  const RunSummary summary = run(system, simulated(25ms));
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(as_error, (std::vector<bool>{true, true, true}));
  EXPECT_EQ(summary.subsystems.at(0).errors, 3u);
}

TEST(SafeCommand, IsGivenAtTheEndOfTheRun) {
  TestSystem system;
  system.add("robot.motor", nets::alone, script_of_a_driver(), 10ms, 0ms, Kind::effector);
  EXPECT_FALSE(run(system, simulated(25ms)).failed);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, 5, 5, -1}));
}

TEST(SafeCommand, IsGivenAtOnceWhenUserCodeThrows) {
  TestSystem system;
  Script script = script_of_a_driver();
  script.call = [](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 1) throw std::runtime_error("oops");
  };
  script.route = [](const ScriptState&, bool) { return to_other; };
  system.add("robot.motor", nets::two_behaviours, script, 10ms, 0ms, Kind::effector);
  EXPECT_FALSE(run(system, simulated(25ms)).failed);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, -1, 5, -1}));
}

TEST(SafeCommand, ReplacesOutputsThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TestSystem system;
    Script script = script_of_a_driver();
    script.call = [bad](ScriptState& state) { state.command = state.context.iteration == 0 ? bad : 5; };
    script.route = [](const ScriptState&, bool) { return to_other; };
    system.add("robot.motor", nets::two_behaviours, script, 10ms, 0ms, Kind::effector);
    const RunSummary summary = run(system, simulated(15ms));
    EXPECT_EQ(summary.subsystems.at(0).errors, 1u);
    EXPECT_EQ(system.devices.commands, (std::vector<double>{-1, 5, -1}));
  }
}

TEST(SafeCommand, FollowsARefusal) {
  TestSystem system;
  Script script = script_of_a_driver();
  script.route = [](const ScriptState&, bool) { return to_other; };
  system.devices.accept = [](double value) { return value < 0; };
  system.add("robot.motor", nets::two_behaviours, script, 10ms, 0ms, Kind::effector);
  const RunSummary summary = run(system, simulated(5ms));
  EXPECT_EQ(summary.subsystems.at(0).errors, 1u);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, -1, -1}));
}

/// control (sends at the times its script says) -> motor, blocking; commands with the time they were given.
struct StaleRun {
  std::vector<std::pair<Duration, double>> commands;
  RunSummary summary;
};
[[nodiscard]] StaleRun run_stale(Duration control_period, Script control, Duration length) {
  TestSystem system;
  StaleRun result;
  Duration now{};
  control.senses = true;  // notes the time, because it acts first at an instant
  Script motor = script_of_a_driver();
  motor.call = [&now](ScriptState& state) {
    now = state.context.now.time_since_epoch();
    state.command = state.x.value();
  };
  const auto a = system.add("robot.control", nets::nb_sender, std::move(control), control_period);
  const auto b = system.add("robot.motor", nets::b_receiver, motor, 0ms, 30ms, Kind::effector);
  system.connect(a, "x", b, "x", buffered);
  result.summary = run(system, simulated(length));
  for (const double command : system.devices.commands) result.commands.emplace_back(now, command);
  return result;
}

TEST(SafeCommand, IsGivenWhenInputsAreStaleAndEndsWhenTheyAreFreshAgain) {
  Script control;
  control.call = [](ScriptState& state) { state.out_x = 10 + static_cast<double>(state.context.iteration); };
  std::vector<double> commands;
  for (const auto& [at, command] : run_stale(100ms, control, 205ms).commands) commands.push_back(command);
  // The motor is called at 0 once without a value (safe), then with 10; stale at 30; 11 at
  // 100; stale at 130; 12 at 200.
  EXPECT_EQ(commands, (std::vector<double>{-1, 10, -1, 11, -1, 12, -1}));
}

TEST(SafeCommand, InvalidValuesAreNoNews) {
  Script control;
  control.call = [](ScriptState& state) {
    state.out_x = 10;
    if (state.context.iteration > 0) throw std::runtime_error("blind");
  };
  control.route = [](const ScriptState&, bool) { return 0; };
  const StaleRun result = run_stale(20ms, control, 25ms);
  EXPECT_TRUE(result.summary.failed);  // no `next` handles the error
  EXPECT_EQ(result.commands.back().second, -1);
}

TEST(SafeCommand, IsGivenWhenNoFirstValueComes) {
  TestSystem system;
  const auto a = system.add("robot.silent", nets::alone, {}, 10ms);
  const auto b = system.add("robot.motor", nets::b_receiver, script_of_a_driver(), 0ms, 30ms, Kind::effector);
  system.connect(a, "", b, "x", buffered);  // no behaviour of it sends: the motor is stuck for good
  EXPECT_TRUE(run(system, simulated(25ms)).failed);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{-1, -1})) << "the second because the run ends";
  system.devices.commands.clear();
  EXPECT_TRUE(run(system, simulated(35ms)).failed);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{-1, -1, -1}));
}

TEST(SafeCommand, IsGivenForGoodWhenTheSourceHasEnded) {
  TestSystem system;
  Script control;
  control.call = [](ScriptState& state) { state.out_x = 10; };
  control.decide = [](const ScriptState& state) {
    return state.context.iteration < 2 ? Outcome::go_on : Outcome::terminal;
  };
  Script motor = script_of_a_driver();
  motor.call = [](ScriptState& state) { state.command = state.x.value(); };
  const auto a = system.add("robot.control", nets::nb_sender, control, 10ms);
  const auto b = system.add("robot.motor", nets::nb_receiver, motor, 10ms, 0ms, Kind::effector);
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, simulated(55ms));
  EXPECT_EQ(summary.ended, "duration");
  const std::vector<double>& commands = system.devices.commands;
  EXPECT_EQ(std::count(commands.begin(), commands.end(), 10.0) > 0, true);
  EXPECT_EQ(commands.front(), -1) << "no value has come yet";
  const auto first_safe = std::find(std::find(commands.begin(), commands.end(), 10.0), commands.end(), -1.0);
  EXPECT_TRUE(std::all_of(first_safe, commands.end(), [](double command) { return command == -1; }));
  EXPECT_GE(commands.end() - first_safe, 4);
}

TEST(RealReceptor, FillsItsBufferAndSaysWhenThereIsNoValue) {
  TestSystem system;
  std::vector<std::tuple<double, bool, Duration>> seen;
  int reads = 0;
  system.devices.sense = [&](double& value) {
    value = ++reads;
    return reads != 2;
  };
  Script script;
  script.senses = true;
  script.call = [&](ScriptState& state) {
    seen.emplace_back(state.sensed.value(), state.sensed.fresh, state.sensed.age);
  };
  system.add("robot.eye", nets::alone, script, 10ms, 0ms, Kind::receptor);
  EXPECT_FALSE(run(system, simulated(25ms)).failed);
  EXPECT_EQ(seen, (std::vector<std::tuple<double, bool, Duration>>{
                      {1, true, 0ms}, {1, false, 10ms}, {3, true, 0ms}}));
}

TEST(RealReceptor, ThatThrowsIsAnErrorAndItsFunctionIsNotCalled) {
  TestSystem system;
  system.devices.sense = [](double&) -> bool { throw std::runtime_error("unplugged"); };
  int calls = 0;
  Script script;
  script.senses = true;
  script.call = [&](ScriptState&) { ++calls; };
  script.route = [](const ScriptState&, bool) { return to_other; };
  system.add("robot.eye", nets::two_behaviours, script, 10ms, 0ms, Kind::receptor);
  const RunSummary summary = run(system, simulated(15ms));
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(summary.subsystems.at(0).errors, 2u);
}

}  // namespace
}  // namespace tessera::testing
