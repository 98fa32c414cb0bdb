#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Calls at which times.
[[nodiscard]] Script noting(std::vector<Duration>& times) {
  Script script;
  script.call = [&times](ScriptState& state) { times.push_back(state.context.now.time_since_epoch()); };
  return script;
}

TEST(SimulatedRun, CallsAreReleasedOnAGrid) {
  TestSystem system;
  std::vector<Duration> times;
  system.add("robot.a", nets::alone, noting(times), 10ms);
  const RunSummary summary = run(system, simulated(45ms));
  EXPECT_EQ(times, (std::vector<Duration>{0ms, 10ms, 20ms, 30ms, 40ms}));
  EXPECT_EQ(summary.ended, "duration");
  EXPECT_EQ(summary.simulated, 45ms);
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(summary.subsystems.at(0).overruns, 0u);
}

TEST(SimulatedRun, GridSurvivesAChangeOfBehaviour) {
  TestSystem system;
  std::vector<Duration> times;
  Script script = noting(times);
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  EXPECT_FALSE(run(system, simulated(35ms)).failed);
  EXPECT_EQ(times, (std::vector<Duration>{0ms, 10ms, 20ms, 30ms}));
}

/// Also if the behaviour follows itself, and in conditions as in transition functions.
TEST(SimulatedRun, TimeInABehaviourBeginsWithItsFirstCall) {
  TestSystem system;
  std::vector<Duration> called, decided;
  std::vector<std::uint32_t> indices;
  Script script;
  script.call = [&](ScriptState& state) {
    called.push_back(state.context.in_behaviour);
    indices.push_back(state.context.index);
  };
  script.decide = [&](const ScriptState& state) {
    decided.push_back(state.context.in_behaviour);
    return state.context.in_behaviour >= 20ms ? Outcome::terminal : Outcome::go_on;
  };
  system.add("robot[7].a", nets::two_behaviours, script, 10ms);
  EXPECT_FALSE(run(system, simulated(75ms)).failed);
  EXPECT_EQ(called, (std::vector<Duration>{0ms, 10ms, 20ms, 0ms, 10ms, 20ms, 0ms, 10ms}));
  EXPECT_EQ(decided, called);
  EXPECT_EQ(indices, std::vector<std::uint32_t>(8, 7));
}

TEST(SimulatedRun, EndsWhenTheNetEnds) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState& state) {
    return state.context.iteration < 3 ? Outcome::go_on : Outcome::terminal;
  };
  system.add("robot.a", nets::alone, script, 10ms);
  RunOptions options;
  options.recording = scratch_file("run");
  options.values = RunOptions::Values::none;
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "net ended");
  EXPECT_EQ(summary.subsystems.at(0).iterations, 4u);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  // t_in, t_out of both upper layers; t_in; 4 iterations of 6 firings; t_run_0.
  EXPECT_EQ(summary.firings, 4u + 1u + 4u * 6u + 1u);
  EXPECT_EQ(recording->entries.size(), summary.firings + 1);  // and why it ended
  EXPECT_EQ(recording->entries.back().text, "net ended");
}

constexpr Behaviour slow_behaviour[] = {{"run", 15ms}};

TEST(SimulatedRun, UserCodeTakesTheTimeItDeclaresAndMissesReleases) {
  TestSystem system;
  std::vector<Duration> times;
  const SubsystemNet slow{slow_behaviour, {}, nets::alone.places, nets::alone.transitions};
  system.add("robot.a", slow, noting(times), 10ms);
  const RunSummary summary = run(system, simulated(70ms));
  EXPECT_EQ(times, (std::vector<Duration>{0ms, 20ms, 40ms, 60ms}));
  EXPECT_EQ(summary.subsystems.at(0).overruns, 3u);
}

TEST(SimulatedRun, WaitingForAnotherSubsystemIsNoOverrun) {
  TestSystem system;
  std::vector<Duration> times;
  const auto a = system.add("robot.a", nets::nb_sender, {}, 50ms);
  const auto b = system.add("robot.b", nets::b_receiver, noting(times), 20ms);
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, simulated(130ms));
  EXPECT_EQ(times, (std::vector<Duration>{0ms, 20ms, 60ms, 100ms}));
  EXPECT_EQ(summary.subsystems.at(1).overruns, 0u);
}

TEST(SimulatedRun, IterationCountsOverAllBehaviours) {
  TestSystem system;
  std::vector<std::uint64_t> iterations;
  Script script;
  script.call = [&](ScriptState& state) { iterations.push_back(state.context.iteration); };
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  EXPECT_FALSE(run(system, simulated(35ms)).failed);
  EXPECT_EQ(iterations, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

/// Two subsystems that write to one log at the same instants, and a noisy pair of channels.
[[nodiscard]] std::string recorded(std::uint64_t seed, const std::string& name) {
  TestSystem system;
  Script talks;
  talks.call = [](ScriptState& state) { state.context.log("{}", state.context.iteration); };
  const auto a = system.add("robot.a", nets::async_sender, talks, 10ms);
  const auto b = system.add("robot.b", nets::async_receiver, talks, 10ms);
  system.add("robot.c", nets::alone, talks, 10ms);
  system.connect(a, "x", b, "x", asynchronous);
  RunOptions options = simulated(200ms);
  options.seed = seed;
  options.recording = scratch_file(name);
  EXPECT_FALSE(run(system, options).failed);
  std::string bytes = file_bytes(options.recording);
  return bytes.substr(bytes.find("\"clock\""));  // the header before it holds the seed itself
}

TEST(SimulatedRun, TheSameSeedMakesTheSameBytes) { EXPECT_EQ(recorded(7, "first"), recorded(7, "second")); }

TEST(SimulatedRun, AnotherSeedBreaksTiesInAnotherWay) {
  EXPECT_NE(recorded(7, "first"), recorded(8, "second"));
}

TEST(SimulatedRun, EndsWhenNothingCanEverHappenAgainAndSaysWhoWaitsForWhom) {
  TestSystem system;
  Script once;
  once.decide = [](const ScriptState&) { return Outcome::terminal; };
  const auto a = system.add("robot.a", nets::nb_sender, once, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, {});
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, simulated(1h));
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended,
            "stopped: nothing can ever happen again: robot.b at run.rcv.in waits for robot.a over 'x', which "
            "has ended");
}

TEST(SimulatedRun, ASubsystemInWhichTimeStandsStillIsAFault) {
  TestSystem system;
  system.add("robot.a", nets::alone, {});
  const RunSummary summary = run(system, simulated(1s));
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended, "stopped: robot.a: time stands still: it fires for ever at one instant");
}

TEST(SimulatedRun, ABehaviourMayStopTheSystem) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState& state) {
    if (state.context.iteration == 3) state.context.stop("seen enough");
  };
  system.add("robot.a", nets::alone, script, 10ms);
  const RunSummary summary = run(system, simulated(1s));
  EXPECT_EQ(summary.ended, "stopped: seen enough");
  EXPECT_FALSE(summary.failed);
  EXPECT_EQ(summary.simulated, 30ms);
}

TEST(SimulatedRun, LogLinesAreRecordedWithTimeAndPath) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState& state) {
    state.context.warn("gain {:.1f} {}", state.gain, std::string(600, 'x'));
  };
  system.add("robot.a", nets::alone, script, 10ms);
  RunOptions options = simulated(15ms);
  options.recording = scratch_file("run");
  EXPECT_FALSE(run(system, options).failed);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  std::vector<std::string> texts;
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() != Event::Kind::log) continue;
    EXPECT_EQ(entry.event.version, static_cast<std::uint32_t>(LogLevel::warning));
    EXPECT_EQ(recording->instances.at(entry.event.instance()), "robot.a");
    texts.push_back(entry.text);
  }
  const std::string expected = "gain 1.0 " + std::string(512 - 9, 'x');
  EXPECT_EQ(texts, (std::vector<std::string>{expected, expected}));
}

}  // namespace
}  // namespace tessera::testing
