#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

TEST(SteadyRun, EndsWhenTheNetEnds) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState& state) {
    return state.context.iteration < 5 ? Outcome::go_on : Outcome::terminal;
  };
  system.add("one.a", nets::alone, script, 1ms);
  system.add("one.b", nets::alone, script, 2ms);
  system.add("two.c", nets::alone, script, 1ms);
  RunOptions options = steady(60s);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "net ended");
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  // On a busy machine it may miss instants of its rate, which is recorded too.
  const auto firings =
      std::count_if(recording->entries.begin(), recording->entries.end(),
                    [](const auto& entry) { return entry.event.kind() == Event::Kind::firing; });
  EXPECT_EQ(static_cast<std::uint64_t>(firings), summary.firings);
  EXPECT_EQ(recording->entries.back().text, "net ended");
}

TEST(SteadyRun, StopWakesThoseWhoWait) {
  TestSystem system;
  Script stops;
  stops.call = [](ScriptState& state) {
    if (state.context.iteration == 5) state.context.stop("enough");
  };
  const auto a = system.add("robot.a", nets::nb_sender, {}, 1h);
  const auto b = system.add("robot.b", nets::b_receiver, {});
  system.add("robot.c", nets::alone, stops, 1ms);
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, steady(60s));
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_FALSE(summary.failed);
  EXPECT_LT(summary.wall_s, 30);
}

TEST(SteadyRun, EndsWhenNothingCanEverHappenAgainAndSaysWhoWaitsForWhom) {
  TestSystem system;
  Script once;
  once.decide = [](const ScriptState&) { return Outcome::terminal; };
  const auto a = system.add("robot.a", nets::nb_sender, once, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, {});
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, steady(60s));
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.ended,
            "stopped: nothing can ever happen again: robot.b at run.rcv.in waits for robot.a over 'x', which "
            "has ended");
}

TEST(SteadyRun, DoesNotTakeALongTransitionFunctionForTheEnd) {
  TestSystem system;
  Script slow;
  slow.call = [](ScriptState& state) {
    if (state.context.iteration == 1) std::this_thread::sleep_for(1s);
    if (state.context.iteration == 2) state.context.stop("enough");
  };
  const auto a = system.add("robot.a", nets::nb_sender, slow);
  const auto b = system.add("robot.b", nets::b_receiver, {});
  system.connect(a, "x", b, "x", buffered);
  const RunSummary summary = run(system, steady(60s));
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_FALSE(summary.failed);
}

TEST(SteadyRun, SignalsStopItSafely) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, std::pair{SIGTERM, "SIGTERM"}}) {
    for (const RunOptions::Clock clock : {RunOptions::Clock::simulated, RunOptions::Clock::steady}) {
      TestSystem system;
      Script motor;
      motor.acts = true;
      motor.call = [signal = signal](ScriptState& state) {
        state.command = 5;
        if (state.context.iteration == 3) kill(getpid(), signal);
      };
      system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector);
      RunOptions options = simulated(24h * 365);
      options.clock = clock;
      const RunSummary summary = run(system, options);
      EXPECT_EQ(summary.ended, name);
      EXPECT_FALSE(summary.failed);
      EXPECT_EQ(system.devices.commands.back(), -1);
    }
  }
}

TEST(SteadyRun, ReleasesDoNotDrift) {
  TestSystem system;
  std::vector<Duration> times;
  Script script;
  script.call = [&](ScriptState& state) {
    times.push_back(state.context.now.time_since_epoch());
    if (times.size() == 20) state.context.stop("enough");
  };
  system.add("robot.a", nets::alone, script, 2ms);
  EXPECT_EQ(run(system, steady(60s)).ended, "stopped: enough");
  ASSERT_EQ(times.size(), 20u);
  for (std::size_t index = 1; index < times.size(); ++index) {
    EXPECT_GE(times[index], times[index - 1]);
    EXPECT_GE(times[index] / Duration(2ms), static_cast<std::int64_t>(index)) << "never before its release";
  }
}

TEST(SteadyRun, MayFollowAnotherInOneProcess) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::terminal; };
  system.add("robot.a", nets::alone, script);
  for (int round = 0; round < 20; ++round) EXPECT_EQ(run(system, steady(60s)).ended, "net ended");
}

TEST(SteadyRun, ARingWithoutRatesStarvesNobodyAndStaysLegal) {
  TestSystem system;
  std::atomic<int> left = 3;
  Script relay;
  relay.call = [&left](ScriptState& state) {
    if (state.context.iteration == 100 && --left == 0) state.context.stop("enough");
  };
  const auto a = system.add("robot.a", nets::async_relay, relay);
  const auto b = system.add("robot.b", nets::async_relay, relay);
  const auto c = system.add("robot.c", nets::async_relay, relay);
  system.connect(a, "out", b, "in", asynchronous);
  system.connect(b, "out", c, "in", asynchronous);
  system.connect(c, "out", a, "in", asynchronous);
  RunOptions options = steady(60s);  // without rates: as fast as it goes
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(summary.ended, "stopped: enough");
  if (summary.lost_events == 0) {
    EXPECT_EQ(complaint_about(*recording, system.system()), "");
  }
}

}  // namespace
}  // namespace tessera::testing
