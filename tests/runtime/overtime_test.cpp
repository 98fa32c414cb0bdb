// Calls that take longer than declared, and threads that go on late.
#include "tessera/overtime.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "subsystem/overtimes.hpp"
#include "system/processor_clocks.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// When, whether nothing fails because of it, and its text.
using ToldOvertime = std::tuple<Duration, bool, std::string>;

/// One effector, whose errors lead from behaviour `first`, which takes 1 to 2 ms, to `second`, and `second` back.
struct SlowRobot {
  std::vector<Behaviour> behaviours{{"first", 2ms}, {"second"}};
  SubsystemNet net = nets::two_behaviours;
  TestSystem system;
  std::vector<std::uint16_t> called;
  std::function<void()> work;
  std::string file = scratch_file("run");
  bool stops = false;  // after five calls from 20 ms on
  int after_20ms = 0;
  std::optional<Recording> recording;

  const System& build(Overtime reaction, bool acts = true) {
    net.behaviours = behaviours;
    Script script;
    script.acts = acts;
    script.call = [this](ScriptState& state) {
      called.push_back(state.behaviour);
      state.command = 5;
      after_20ms += static_cast<int>(state.context.now >= Time(20ms));
      if (work) work();
      if (stops && after_20ms == 5) state.context.stop("enough");
    };
    script.decide = [](const ScriptState& state) {
      return state.behaviour == 1 ? Outcome::terminal : Outcome::go_on;
    };
    Policies policies;
    policies.overtime = reaction;
    system.add("robot.a", net, script, 10ms, 0ms, acts ? Kind::effector : Kind::control, policies);
    return system.system();
  }
  /// The run must be legal.
  RunSummary run_it(RunOptions options) {
    stops = options.clock == RunOptions::Clock::steady;
    options.recording = file;
    const RunSummary summary = run(system, options);
    EXPECT_FALSE(summary.failed) << summary.ended;
    std::string error;
    recording = read_recording(file, error);
    EXPECT_TRUE(recording) << error;
    EXPECT_EQ(recording ? complaint_about(*recording, system.system()) : "", "");
    return summary;
  }
  std::vector<ToldOvertime> told() const {
    std::vector<ToldOvertime> all;
    for (const auto& [event, text] : recording->entries)
      if (event.kind() == Event::Kind::fault && event.fault() == Fault::overtime)
        all.emplace_back(Duration(event.time_ns), event.is_told_fault(), text);
    return all;
  }
};

RunOptions planted(RunOptions options, const std::string& fault) {
  options.inject = {fault};
  return options;
}

TEST(OvertimeOfRuns, OfACallIsToldAndTheRunGoesOn) {
  SlowRobot robot;
  robot.build(Overtime::tell);
  const RunSummary summary = robot.run_it(planted(simulated(45ms), "robot.a:stall=6ms@10ms"));
  EXPECT_EQ(robot.told(), (std::vector<ToldOvertime>{
                              {18ms, true, "robot.a.first.in: took 8 ms, longer than its takes of 2 ms"}}));
  EXPECT_EQ(robot.called, (std::vector<std::uint16_t>{0, 0, 0, 0, 0}));
  EXPECT_EQ(std::count(robot.system.devices.commands.begin(), robot.system.devices.commands.end(), 5), 5);
  EXPECT_EQ(summary.subsystems.at(0).errors, 0U);
  EXPECT_EQ(summary.subsystems.at(0).slow_calls, 1U);
  ASSERT_EQ(summary.overtime.size(), 1U);
  const RunSummary::SlowCalls& one = summary.overtime.front();
  EXPECT_EQ(std::tuple(one.behaviour, one.slow, one.declared, one.longest, one.longest_at),
            std::tuple(std::string("robot.a.first"), 1U, Duration(2ms), Duration(8ms), Time(10ms)));
}

TEST(OvertimeOfRuns, IsToldTheFirstTheTenthAndTheHundredthTime) {
  SlowRobot robot;
  robot.build(Overtime::tell, false);
  const RunSummary summary = robot.run_it(planted(simulated(2s), "robot.a:stall=1ms@10ms.."));
  EXPECT_GT(summary.subsystems.at(0).slow_calls, 100U);
  const std::string text = "robot.a.first.in: took 3 ms, longer than its takes of 2 ms";
  EXPECT_EQ(robot.told(), (std::vector<ToldOvertime>{{13ms, true, text},
                                                     {103ms, true, text + "; it is the 10th time"},
                                                     {1003ms, true, text + "; it is the 100th time"}}));
}

TEST(OvertimeOfRuns, OfACallIsAnErrorWhereThatIsAskedFor) {
  SlowRobot robot;
  robot.build(Overtime::fault);
  const RunSummary summary = robot.run_it(planted(simulated(45ms), "robot.a:stall=6ms@10ms"));
  EXPECT_EQ(robot.told(), (std::vector<ToldOvertime>{
                              {18ms, false,
                               "robot.a.first.in: took 8 ms, longer than its takes of 2 ms; the devices get "
                               "the safe command"}}));
  EXPECT_EQ(robot.called, (std::vector<std::uint16_t>{0, 0, 1, 0, 0}));
  EXPECT_EQ(summary.subsystems.at(0).errors, 1U);
  EXPECT_EQ(summary.subsystems.at(0).slow_calls, 1U);
  EXPECT_EQ(robot.system.devices.commands.at(1), -1) << "the command of the slow call is not given";
}

TEST(OvertimeOfRuns, ComesAgainInARerunOfItsRecording) {
  for (const Overtime reaction : {Overtime::tell, Overtime::fault}) {
    SlowRobot fresh;
    RunOptions options = planted(simulated(45ms), "robot.a:stall=6ms@10ms");
    options.recording = scratch_file("again");
    fresh.build(reaction);
    EXPECT_FALSE(run(fresh.system, options).failed);
    SlowRobot code;
    std::string error;
    const auto report = rerun(code.build(reaction), {}, options.recording, error);
    ASSERT_TRUE(report) << error;
    EXPECT_FALSE(report->first) << name_of(reaction);
  }
}

TEST(OvertimeOfRuns, OfARealCallIsTold) {
  SlowRobot robot;
  robot.behaviours[0] = {"first", 1ms};
  robot.build(Overtime::tell);
  const RunSummary summary = robot.run_it(planted(steady(60s), "robot.a:stall=50ms@20ms"));
  EXPECT_GE(summary.subsystems.at(0).slow_calls, 1U);
  ASSERT_EQ(summary.overtime.size(), 1U);
  EXPECT_GE(summary.overtime.front().longest, 50ms);
  ASSERT_FALSE(robot.told().empty());
  EXPECT_TRUE(std::get<1>(robot.told().front()));
  EXPECT_EQ(summary.subsystems.at(0).errors, 0U);
}

TEST(OvertimeOfRuns, OfARealCallThatHasNotReturnedIsToldWhileItRuns) {
  SlowRobot robot;
  robot.behaviours[0] = {"first", 1ms};
  bool told = false;
  robot.work = [&] {
    for (const auto since = std::chrono::steady_clock::now();
         !told && std::chrono::steady_clock::now() < since + 60s;) {
      std::this_thread::sleep_for(5ms);
      std::string error;
      if (const auto so_far = read_recording(robot.file, error))
        told = std::ranges::any_of(so_far->entries, [](const Recording::Entry& entry) {
          return entry.event.is_told_fault() && entry.text.find("has not returned for") != std::string::npos;
        });
    }
  };
  robot.build(Overtime::tell);
  const RunSummary summary = robot.run_it(steady(120s));
  EXPECT_TRUE(told);
  EXPECT_GE(summary.subsystems.at(0).slow_calls, 1U);
}

TEST(OvertimeOfRuns, OfARealCallIsAnErrorWhereThatIsAskedFor) {
  SlowRobot robot;
  robot.behaviours[0] = {"first", 1ms};
  robot.build(Overtime::fault);
  const RunSummary summary = robot.run_it(planted(steady(60s), "robot.a:stall=50ms@20ms"));
  EXPECT_GE(summary.subsystems.at(0).errors, 1U);
  EXPECT_TRUE(std::ranges::any_of(robot.told(), [](const ToldOvertime& one) { return !std::get<1>(one); }));
  EXPECT_NE(std::find(robot.called.begin(), robot.called.end(), 1), robot.called.end());
}

TEST(OvertimeOfRuns, OfAThreadIsToldOnlyIfALatencyIsDeclaredAndAlwaysMeasured) {
  for (const Duration latency : {0ns, 1ns}) {
    SlowRobot fresh;
    fresh.behaviours = {{"first"}, {"second"}};
    fresh.system.latency = latency;
    fresh.build(Overtime::tell);
    const RunSummary summary = fresh.run_it(steady(60s));
    EXPECT_GT(summary.subsystems.at(0).latest_wakeup, 0ns);
    EXPECT_EQ(summary.subsystems.at(0).late_wakeups > 0, latency > 0ns);
    EXPECT_EQ(fresh.told().empty(), latency == 0ns);
    EXPECT_EQ(summary.subsystems.at(0).errors, 0U);
  }
}

TEST(OvertimeOfRuns, OfAThreadFailsTheNextCallWhereThatIsAskedFor) {
  SlowRobot robot;
  robot.behaviours = {{"first", 1h}, {"second"}};
  robot.system.latency = 1ns;
  robot.build(Overtime::fault);
  const RunSummary summary = robot.run_it(steady(60s));
  EXPECT_GE(summary.subsystems.at(0).errors, 1U);
  EXPECT_EQ(summary.subsystems.at(0).slow_calls, 0U);
  EXPECT_TRUE(std::ranges::any_of(robot.told(), [](const ToldOvertime& one) { return !std::get<1>(one); }));
}

TEST(ProcessorClocks, TellHowLongTheOthersRan) {
  ProcessorClocks clocks(3);
  clocks.enter(0);
  EXPECT_EQ(clocks.used_by_others(0), 0ns);
  std::atomic<bool> ran{false}, ends{false};
  std::thread other([&] {
    clocks.enter(1);
    timespec used{};
    do clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    while (used.tv_sec == 0 && used.tv_nsec < 5'000'000);
    ran = true;
    ran.notify_all();
    ends.wait(false);
  });
  ran.wait(false);
  EXPECT_GE(clocks.used_by_others(0), 5ms);
  EXPECT_GE(clocks.used_by_others(2), clocks.used_by_others(0));
  ends = true;
  ends.notify_all();
  other.join();
}

TEST(Overtimes, LeaveOutTheTimeOfOthersOnAProcessorAndDoNotJudgeThoseThatWaitForIt) {
  const Behaviour behaviours[] = {{"run", 1ms, 3ms}};
  SubsystemNet net;
  net.behaviours = behaviours;
  const Instance instance{"robot", "a", Kind::control, &net, nullptr};
  const auto clocks = std::make_shared<ProcessorClocks>(2);
  Overtimes shared(instance, 1ms, {clocks, 0, /*yields=*/true}), own(instance, 1ms, {});
  for (Overtimes* one : {&shared, &own}) {
    one->begin_call(Time(10ms));
    EXPECT_FALSE(one->over(0, Time(13ms)));
    ASSERT_TRUE(one->over(0, Time(13ms + 1ns)));
    EXPECT_FALSE(one->end_call(0, Time(13ms)));
  }
  EXPECT_FALSE(shared.wake_up(2ms)) << "another one may have run";
  EXPECT_EQ(shared.latest_wakeup(), 0ns);
  ASSERT_TRUE(own.wake_up(2ms));
  EXPECT_EQ(own.take_late()->took, 2ms);
  EXPECT_FALSE(own.take_late());
  EXPECT_FALSE(own.wake_up(1ms));
  EXPECT_EQ(own.latest_wakeup(), 2ms);
}

}  // namespace
}  // namespace tessera::testing
