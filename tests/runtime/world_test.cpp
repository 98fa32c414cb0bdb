#include <gtest/gtest.h>

#include <sstream>

#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// One subsystem that reads where it is and always drives at 2 per second, in the world of FAKE_WORLD.
struct InAWorld : ::testing::Test {
  TestSystem system;
  std::vector<double> positions;
  RunOptions options = simulated(25ms);
  InAWorld() {
    Script script;
    script.senses = script.acts = true;
    script.call = [this](ScriptState& state) {
      positions.push_back(state.sensed.value());
      state.command = 2;
      if (positions.size() == 5) state.context.stop("enough");
    };
    system.add("robot.body", nets::alone, script, 10ms, 0ms, Kind::effector);
    options.world.emplace();
    options.world->world = "flat.xml";
    options.world_library = FAKE_WORLD;
    options.drivers = {{"robot.body.sensed", "position", {"wheel"}, {}},
                       {"robot.body.command", "velocity", {"wheel"}, {}}};
  }
  std::string complaint() {
    std::string error;
    return execute(system.system(), options, error) ? "" : error;
  }
};

TEST_F(InAWorld, MovesInLockStepWithTheSimulatedClock) {
  options.world->trace = scratch_file("trace");
  EXPECT_FALSE(run(system, options).failed);
  ASSERT_EQ(positions.size(), 3u);
  EXPECT_DOUBLE_EQ(positions[0], 0);
  EXPECT_DOUBLE_EQ(positions[1], 0.02);
  EXPECT_DOUBLE_EQ(positions[2], 0.04);
  EXPECT_EQ(bytes_of(options.world->trace), "0\n0.01\n0.02\n0.025\n");
  EXPECT_TRUE(system.devices.commands.empty()) << "the world's device comes before the C++ driver";
}

TEST_F(InAWorld, IsDrivenInRealTimeUnderTheSteadyClock) {
  options.clock = RunOptions::Clock::steady;
  options.duration = 60s;
  EXPECT_EQ(run(system, options).ended, "stopped: enough");
  EXPECT_GT(positions.back(), 0);
}

TEST_F(InAWorld, ThatIsSlowerThanRealTimeFallsBehindAndSaysSo) {
  options.clock = RunOptions::Clock::steady;
  options.world->world = "slow.xml";
  options.world->trace = scratch_file("trace");
  options.duration = 1s;
  TestSystem another;  // without the stop of the fixture's
  Script script;
  script.senses = true;
  another.add("robot.body", nets::alone, script, 10ms);
  options.drivers.pop_back();
  const RunSummary summary = run(another, options);
  EXPECT_EQ(summary.ended, "duration");
  ASSERT_TRUE(summary.world_time);
  EXPECT_LT(*summary.world_time, summary.simulated / 2);
  ASSERT_EQ(summary.warnings.size(), 1U);
  EXPECT_TRUE(summary.warnings[0].starts_with("the simulated world ran at 0.")) << summary.warnings[0];
  double last = 0;
  std::istringstream trace(bytes_of(options.world->trace));
  for (double time = 0; trace >> time; last = time)
    EXPECT_LE(time - last, 0.0101) << "nobody waits longer than for one step";
}

TEST_F(InAWorld, ThatCannotBeOpenedIsSaid) {
  options.world->world = "missing.xml";
  EXPECT_EQ(complaint(), "no such world: missing.xml");
  options.world_library = "/nonexistent.so";
  EXPECT_TRUE(complaint().starts_with("cannot load the world's library: ")) << complaint();
  options.world_library = "";
  EXPECT_EQ(complaint(), "a world is asked for, but no library that simulates one (--world-library)");
}

TEST_F(InAWorld, DevicesItLacksAndBuffersThatAreNoneAreSaid) {
  options.world->track = "wheel";
  options.drivers.push_back({"robot.body.nose", "position", {"wheel"}, {}});
  EXPECT_EQ(complaint(),
            "robot.body.sensed (position 'wheel'): there is no wheel\n"
            "a driver is given for 'robot.body.nose', which is no real buffer");
}

TEST_F(InAWorld, ATraceThatCannotBeWrittenFailsTheRun) {
  options.world->trace = "/dev/full";
  const RunSummary summary = run(system, options);
  EXPECT_TRUE(summary.failed);
  EXPECT_EQ(summary.warnings, std::vector<std::string>{"the world: disk full"});
}

TEST(Devices, ARealBufferWithoutADriverIsNamed) {
  TestSystem system;
  Script script;
  script.senses = script.acts = true;
  system.add("robot.body", nets::alone, script, 10ms);
  System without = system.system();
  without.simulated_drivers = {};
  std::string error;
  EXPECT_FALSE(execute(without, simulated(1ms), error));
  EXPECT_EQ(error,
            "the real buffer robot.body.sensed has no simulated driver\nthe real buffer robot.body.command "
            "has no simulated driver");
}

}  // namespace
}  // namespace tessera::testing
