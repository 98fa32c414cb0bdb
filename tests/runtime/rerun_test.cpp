#include "rerun/rerun.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A sensor, a controller that integrates its input, and a motor.
struct Robot {
  TestSystem system;
  bool remembers = false;
  std::uint64_t readings = 0;
  std::function<void(ScriptState&)> steer = [sum = 0.0](ScriptState& state) mutable {
    sum += state.x * state.gain;
    state.out_x = sum + seconds(state.x.age) + static_cast<double>(state.context.iteration);
  };

  const System& build() {
    system.devices.sense = [this](double& value) {
      value = static_cast<double>(readings * readings % 7);
      return ++readings % 5 != 0;
    };
    Script sensor, control, motor;
    sensor.senses = true;
    sensor.call = [](ScriptState& state) { state.out_x = state.sensed * (state.sensed.fresh ? 2 : 1); };
    control.remembers = remembers;
    control.call = [this](ScriptState& state) {
      ++state.count;
      steer(state);
    };
    motor.acts = true;
    motor.call = [](ScriptState& state) { state.command = -state.x; };
    const auto s = system.add("robot.sensor", nets::async_sender, sensor, 10ms, 0ms, Kind::receptor);
    const auto c = system.add("robot.control", nets::async_relay, control, 7ms);
    const auto m = system.add("robot.motor", nets::async_receiver, motor, 4ms, 0ms, Kind::effector);
    system.connect(s, "x", c, "in", asynchronous);
    system.connect(c, "out", m, "x", asynchronous);
    return system.system();
  }
};

/// Records a run of it; the file.
[[nodiscard]] std::string record(RunOptions options = simulated(500ms), bool remembers = false) {
  Robot robot;
  robot.remembers = remembers;
  robot.build();
  options.recording = scratch_file("run");
  EXPECT_FALSE(run(robot.system, options).failed);
  return options.recording;
}

[[nodiscard]] RerunReport again(Robot& robot, const std::string& recording, const RunOptions& options = {}) {
  std::string error;
  const auto report = rerun(robot.build(), options, recording, error);
  EXPECT_TRUE(report) << error;
  return report.value_or(RerunReport{});
}

[[nodiscard]] std::string complaint(const System& system, const std::string& recording) {
  std::string error;
  EXPECT_FALSE(rerun(system, {}, recording, error));
  return error;
}

TEST(Rerun, TheSameCodeDoesTheSame) {
  const std::string recording = record();
  Robot robot;
  const RerunReport report = again(robot, recording);
  EXPECT_FALSE(report.first) << rerun_text(report);
  ASSERT_EQ(report.subsystems.size(), 3U);
  EXPECT_EQ(report.subsystems[0].iterations, 50U);
  EXPECT_GT(report.subsystems[1].iterations, 40U);
  EXPECT_EQ(robot.readings, 0U);  // only the recording is used
  EXPECT_TRUE(robot.system.devices.commands.empty());
}

TEST(Rerun, MemoryMayBeInTheRecordingAndNeedNot) {
  for (const bool recorded : {false, true})
    for (const bool remembers : {false, true}) {
      const std::string recording = record(simulated(500ms), recorded);
      Robot robot;
      robot.remembers = remembers;
      const RerunReport report = again(robot, recording);
      EXPECT_FALSE(report.first) << rerun_text(report);
      EXPECT_GT(report.subsystems.at(1).iterations, 40U);
    }
}

TEST(Rerun, TheSameCodeDoesTheSameAfterARunOfThreads) {
  const std::string recording = record(steady(500ms));
  Robot robot;
  const RerunReport report = again(robot, recording);
  EXPECT_FALSE(report.first) << rerun_text(report);
  EXPECT_GT(report.subsystems[1].iterations, 10U);
}

TEST(Rerun, NamesTheFirstDifferenceAndCountsTheOthers) {
  const std::string recording = record();
  Robot robot;
  robot.steer = [inner = robot.steer](ScriptState& state) {
    inner(state);
    if (state.context.iteration >= 30) state.out_x += 1;
  };
  const RerunReport report = again(robot, recording);
  ASSERT_TRUE(report.first);
  EXPECT_EQ(report.first->subsystem, "robot.control");
  EXPECT_EQ(report.first->iteration, 30U);
  EXPECT_EQ(report.first->at, Time(210ms));
  EXPECT_EQ(report.first->what, "x");
  EXPECT_EQ(std::stod(report.first->computed), std::stod(report.first->recorded) + 1);
  // The motor got the commands that the recorded controller had sent, so it acts the same.
  EXPECT_EQ(report.subsystems[2].outputs[2].differing, 0U);
  EXPECT_EQ(report.subsystems[1].outputs[0].path, "robot.control.x");
  EXPECT_EQ(report.subsystems[1].outputs[0].differing, report.subsystems[1].iterations - 30);
  EXPECT_NE(rerun_text(report).find("first at 0.210000 s: robot.control, iteration 30: x: recorded "),
            std::string::npos)
      << rerun_text(report);
}

TEST(Rerun, TakesParametersOfTheRecordingAndThenItsOwn) {
  RunOptions options = simulated(200ms);
  options.parameters = {{"robot.control.gain", "0.5"}};
  const std::string recording = record(options);
  {
    Robot robot;
    EXPECT_FALSE(again(robot, recording).first);
  }
  Robot robot;
  options = {};
  options.parameters = {{"robot.control.gain", "0.25"}};
  const RerunReport report = again(robot, recording, options);
  ASSERT_TRUE(report.first);
  EXPECT_EQ(report.first->what, "x");
}

TEST(Rerun, ADecisionMadeInAnotherWayIsADifferenceAndTheRecordedPathIsTaken) {
  const auto build = [](TestSystem& system, std::uint64_t last) {
    Script script;
    script.decide = [last](const ScriptState& state) {
      return state.context.iteration < last ? Outcome::go_on : Outcome::terminal;
    };
    system.add("robot.a", nets::alone, script, 10ms);
  };
  RunOptions options = simulated(1s);
  options.recording = scratch_file("run");
  {
    TestSystem system;
    build(system, 5);
    EXPECT_EQ(run(system, options).ended, "net ended");
  }
  TestSystem system;
  build(system, 3);
  std::string error;
  const auto report = rerun(system.system(), {}, options.recording, error);
  ASSERT_TRUE(report) << error;
  ASSERT_TRUE(report->first);
  EXPECT_EQ(report->first->what, "the transition taken");
  EXPECT_EQ(report->first->recorded, "run.t4");
  EXPECT_EQ(report->first->computed, "run.t5");
  EXPECT_EQ(report->first->iteration, 3U);
  EXPECT_EQ(report->subsystems[0].iterations, 6U);
  EXPECT_EQ(report->subsystems[0].decisions, 2U);
}

TEST(Rerun, FailuresComeAgain) {
  const auto build = [](TestSystem& system, std::uint64_t throws_at) {
    static std::uint64_t reads;
    reads = 0;
    system.devices.sense = [](double& value) {
      value = static_cast<double>(reads);
      if (++reads == 12) throw std::runtime_error("unplugged");
      return true;
    };
    Script script;
    script.senses = true;
    script.call = [throws_at](ScriptState& state) {
      state.out_x = state.sensed.value();
      if (state.context.iteration == throws_at) throw std::runtime_error("lost");
    };
    const auto a = system.add("robot.a", nets::nb_sender_persistent, script, 10ms, 0ms, Kind::receptor);
    const auto b = system.add("robot.b", nets::b_receiver, {});
    system.connect(a, "x", b, "x", buffered);
  };
  RunOptions options = simulated(300ms);
  options.recording = scratch_file("run");
  {
    TestSystem system;
    build(system, 5);
    EXPECT_EQ(run(system, options).subsystems[0].errors, 2U);
  }
  const auto first_of = [&](std::uint64_t throws_at) {
    TestSystem system;
    build(system, throws_at);
    std::string error;
    const auto report = rerun(system.system(), {}, options.recording, error);
    EXPECT_TRUE(report) << error;
    return report ? report->first : std::nullopt;
  };
  EXPECT_FALSE(first_of(5));
  const auto first = first_of(99);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->what, "the transition function of run");
  EXPECT_EQ(first->recorded, "robot.a.run.in: lost");
  EXPECT_EQ(first->computed, "succeeded");
}

TEST(Rerun, TimeoutsAndAgesAreThoseOfTheRecording) {
  const auto build = [](TestSystem& system) {
    Script receiver;
    receiver.call = [](ScriptState& state) {
      state.out_x = state.x.timed_out ? -1 : seconds(state.x.age);
      state.out_y = state.x.fresh ? seconds(state.x.stamp.time_since_epoch()) : 0;
    };
    receiver.decide = [](const ScriptState& state) {
      return state.x.age > 8ms && state.x.age < 9ms ? Outcome::error : Outcome::go_on;
    };
    const auto a = system.add("robot.a", nets::nb_sender_persistent, {}, 11ms);
    const auto b = system.add("robot.b", nets::b_receiver_timed, receiver, 2ms);
    system.connect(a, "x", b, "x", buffered, 0ms, 3ms);
  };
  for (RunOptions options : {simulated(300ms), steady(300ms)}) {
    options.recording = scratch_file("run");
    {
      TestSystem system;
      build(system);
      static_cast<void>(run(system, options));
    }
    TestSystem system;
    build(system);
    std::string error;
    const auto report = rerun(system.system(), {}, options.recording, error);
    ASSERT_TRUE(report) << error;
    EXPECT_FALSE(report->first) << rerun_text(*report);
  }
}

TEST(Rerun, AStopThatIsAskedForOnlyNowIsADifference) {
  const std::string recording = record();
  Robot robot;
  robot.steer = [inner = robot.steer](ScriptState& state) {
    inner(state);
    if (state.context.iteration == 10) state.context.stop("enough");
  };
  const RerunReport report = again(robot, recording);
  ASSERT_TRUE(report.first);
  EXPECT_EQ(report.first->what, "the end");
  EXPECT_EQ(report.first->recorded, "goes on");
  EXPECT_EQ(report.first->computed, "stopped: enough");
  EXPECT_EQ(report.first->at, Time(70ms));
}

TEST(Rerun, RefusesARecordingThatDoesNotFit) {
  const std::string recording = record(simulated(50ms));
  RunOptions bare = simulated(50ms);
  bare.values = RunOptions::Values::none;
  {
    TestSystem other;
    other.add("robot.a", nets::alone, {}, 10ms);
    EXPECT_NE(complaint(other.system(), recording).find("it is a recording of another net"),
              std::string::npos);
  }
  {
    Robot robot;
    EXPECT_EQ(complaint(robot.build(), "/nonexistent"), "cannot read '/nonexistent'");
  }
  {
    const std::string without = scratch_file("without");
    Robot first;
    first.build();
    bare.recording = without;
    static_cast<void>(run(first.system, bare));
  }
  Robot robot;
  EXPECT_NE(complaint(robot.build(), scratch_file("without")).find("it holds no values of buffers"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::testing
