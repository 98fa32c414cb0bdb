#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "recorder/pose_recorder.hpp"
#include "tessera/poses.hpp"
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
  EXPECT_EQ(file_bytes(options.world->trace), "0\n0.01\n0.02\n0.025\n");
  EXPECT_TRUE(system.devices.commands.empty()) << "the world's device comes before the C++ driver";
}

TEST_F(InAWorld, ASignalEndsTheRunHoweverFarTheWorldHasToGo) {
  options.world->world = "stopped.xml";
  options.duration = 5s;
  TestSystem slow;
  Script script;
  script.senses = script.acts = true;
  slow.add("robot.body", nets::alone, script, 2s, 0ms, Kind::effector);
  const RunSummary summary = run(slow, options);
  EXPECT_EQ(summary.signal, SIGTERM);
  EXPECT_LE(summary.simulated, 10ms);
}

/// Also at the last instant of the run, which no event follows.
TEST_F(InAWorld, AWorldThatFailsStopsTheRunWithItsReason) {
  options.world->world = "fails.xml";
  for (const Duration duration : {Duration(20ms), Duration(5s)}) {
    options.duration = duration;
    const RunSummary summary = run(system, options);
    EXPECT_TRUE(summary.failed);
    EXPECT_EQ(summary.failure, RunSummary::Failure::world);
    EXPECT_EQ(summary.ended, "stopped: the world: the physics failed at 0.020 s");
    EXPECT_EQ(summary.simulated, 20ms);
  }
}

/// The recorded poses of the first body, by time in ms.
[[nodiscard]] std::map<std::int64_t, double> places_in(const Recording& recording) {
  std::map<std::int64_t, double> places;
  PoseDecoder decoder(recording.scene->bodies.size());
  for (const Recording::Entry& entry : recording.entries) {
    if (entry.event.kind() != Event::Kind::poses) continue;
    EXPECT_TRUE(decoder.take(entry.text));
    if (decoder.known()) places[entry.event.time_ns / 1'000'000] = pose_of(decoder.poses()[0]).position_m[0];
  }
  return places;
}

TEST_F(InAWorld, ItsPosesAndSceneAreRecorded) {
  options.world->world = "seen.xml";
  options.recording = scratch_file("seen.tsr");
  EXPECT_FALSE(run(system, options).failed);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  ASSERT_TRUE(recording->scene);
  ASSERT_EQ(recording->scene->bodies.size(), 2u);
  EXPECT_EQ(recording->scene->bodies[0].name, "wheel");
  EXPECT_EQ(recording->scene->bodies[0].agent, "robot");
  EXPECT_EQ(file_bytes(scene_file(options.recording, recording->scene->hash)), "glTF");
  EXPECT_EQ(places_in(*recording),
            (std::map<std::int64_t, double>{{0, 0}, {10, 0.02}, {20, 0.04}, {25, 0.05}}));
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
}

TEST_F(InAWorld, PosesAreRecordedUnderTheSteadyClockToo) {
  options.world->world = "seen.xml";
  options.clock = RunOptions::Clock::steady;
  options.duration = 60s;
  options.recording = scratch_file("seen.tsr");
  EXPECT_EQ(run(system, options).ended, "stopped: enough");
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  const auto places = places_in(*recording);
  ASSERT_GT(places.size(), 3u);
  EXPECT_GT(places.rbegin()->second, places.begin()->second);
  EXPECT_EQ(complaint_about(*recording, system.system()), "");
}

TEST_F(InAWorld, EverySegmentHasPosesThatCanBeReadWithoutTheOnesBefore) {
  options.world->world = "seen.xml";
  options.duration = 30s;
  options.recording = scratch_file("seen.tsr");
  options.record_limit = {100'000, 2};
  Script script;
  script.senses = script.acts = true;
  script.call = [](ScriptState& state) { state.command = 2; };
  TestSystem endless;
  endless.add("robot.body", nets::alone, script, 10ms, 0ms, Kind::effector);
  EXPECT_FALSE(run(endless, options).failed);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  ASSERT_GT(recording->segment.value_or(0), 0u) << "the first segments are gone";
  const auto places = places_in(*recording);
  const std::int64_t begin_ms = recording->entries.front().event.time_ns / 1'000'000;
  EXPECT_LE(places.begin()->first, begin_ms + 1000);
  EXPECT_NEAR(places.rbegin()->second, 60, 1e-4);
}

TEST(KeptScene, StandsBesideTheRecordingOrSaysWhyNot) {
  const WorldScene scene{.glb = "glTF and more", .bodies = {}};
  const std::string recording = scratch_file("kept.tsr");
  std::ofstream(recording) << recording_magic;
  const std::string file = scene_file(recording, hash_of(scene));
  std::string error;
  for (int time = 0; time < 2; ++time) EXPECT_EQ(keep_scene(scene, recording, error), file);
  EXPECT_EQ(error, "");
  EXPECT_EQ(file_bytes(file), scene.glb);
  std::ofstream(file) << "cut";
  EXPECT_EQ(keep_scene(scene, recording, error), file);
  EXPECT_EQ(file_bytes(file), scene.glb);
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_EQ(keep_scene(scene, recording, error), "");
  EXPECT_NE(error.find("cannot be written to '" + file), std::string::npos) << error;
  std::filesystem::remove(file);
}

TEST_F(InAWorld, WithoutARegularFileItsSceneIsNotKept) {
  options.world->world = "seen.xml";
  options.recording = "/dev/null";
  EXPECT_FALSE(run(system, options).failed);
  for (const auto& entry : std::filesystem::directory_iterator("/dev"))
    EXPECT_NE(entry.path().extension(), ".glb");
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
  std::istringstream trace(file_bytes(options.world->trace));
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
