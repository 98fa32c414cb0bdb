#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// The paper's example without its robot: the motor gets the reading of the eye, times two.
struct LineFollower : ::testing::TestWithParam<RunOptions::Clock> {
  TestSystem system;
  std::vector<std::uint16_t> behaviours;  // of control
  int decisions = 0;                      // of control
  LineFollower() {
    system.devices.sense = [](double& value) {
      value = 3;
      return true;
    };
    Script sensor, control, motor;
    sensor.senses = true;
    sensor.call = [](ScriptState& state) { state.out_x = state.sensed.value(); };
    control.call = [this](ScriptState& state) {
      behaviours.push_back(state.behaviour);
      state.out_x = state.x.value() * 2;
      if (behaviours.size() == 20) state.context.stop("enough");
    };
    control.decide = [this](const ScriptState& state) {
      ++decisions;
      return state.behaviour == 0 ? Outcome::terminal : Outcome::go_on;
    };
    motor.acts = true;
    motor.call = [](ScriptState& state) { state.command = state.x.value(); };
    const auto c = system.add("robot.control", nets::paper_control, control, 50ms);
    const auto s = system.add("robot.sensor", nets::paper_sensor, sensor, 20ms, 0ms, Kind::receptor);
    const auto m = system.add("robot.motor", nets::paper_motor, motor, 20ms, 500ms, Kind::effector);
    system.connect(s, "line", c, "line", asynchronous);
    system.connect(c, "motion", m, "velocity", buffered, 0ms, 200ms);
  }
};

TEST_P(LineFollower, RunsItsNetAndItsValuesReachTheMotor) {
  RunOptions options = simulated(60s);
  options.clock = GetParam();
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "stopped: enough");
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
  EXPECT_EQ(std::count(behaviours.begin(), behaviours.end(), 0), 1) << "init is left after one iteration";
  EXPECT_EQ(decisions, static_cast<int>(behaviours.size()) - 1)
      << "conditions are evaluated once per iteration";
  EXPECT_GT(std::count(system.devices.commands.begin(), system.devices.commands.end(), 6.0), 5);
  EXPECT_EQ(system.devices.commands.back(), -1);
}

INSTANTIATE_TEST_SUITE_P(Clocks, LineFollower,
                         ::testing::Values(RunOptions::Clock::simulated, RunOptions::Clock::steady),
                         [](const auto& clock) {
                           return clock.param == RunOptions::Clock::simulated ? "simulated" : "steady";
                         });

}  // namespace
}  // namespace tessera::testing
