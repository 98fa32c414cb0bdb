#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "controlled_run.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using nlohmann::json;

TEST_F(Controlled, PausesStepsAndSpeedChangeNothingInTheRecording) {
  {
    TestSystem plain;
    build(plain);
    RunOptions options;
    options.duration = 1s;
    options.recording = scratch_file("plain");
    static_cast<void>(run(plain, options));
  }
  start();
  json now = rest(1);
  for (std::uint64_t step = 2; step < 12; ++step) {
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    now = rest(step);
  }
  EXPECT_EQ(command({{"command", "step_iteration"}, {"subsystem", "robot.b"}}), "");
  rest(12);
  EXPECT_EQ(command({{"command", "speed"}, {"value", 1000}}), "");
  finish();
  EXPECT_EQ(summary_.ended, "duration");
  EXPECT_EQ(file_bytes(options_.recording), file_bytes(scratch_file("plain")));
}

TEST_F(Controlled, AStepIsOneFiringAndTheRecordingShowsItAtOnce) {
  start();
  rest(1);
  const std::size_t before = firings_in(options_.recording);
  EXPECT_EQ(before, 2U);  // t_in of system and agent
  for (std::uint64_t step = 1; step <= 5; ++step) {
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    rest(1 + step);
    EXPECT_EQ(firings_in(options_.recording), before + step);
  }
  finish();
}

TEST_F(Controlled, AnIterationEndsWhenTheTransitionFunctionIsCalledAgain) {
  start();
  rest(1);
  const auto iterations_of_b = [](const json& line) {
    return line.at("subsystems").at(1).at("iterations").get<std::uint64_t>();
  };
  std::uint64_t before = 0;
  for (std::uint64_t step = 2; step < 6; ++step) {
    EXPECT_EQ(command({{"command", "step_iteration"}, {"subsystem", "robot.b"}}), "");
    const std::uint64_t after = iterations_of_b(rest(step));
    EXPECT_EQ(after, before + 1);
    before = after;
  }
  finish();
}

TEST_F(Controlled, SnapshotsShowTheMemoryAtTheEndOfTheLastIteration) {
  build_ = [](TestSystem& system) {
    Script counter;
    counter.remembers = true;
    counter.call = [](ScriptState& state) { ++state.count; };
    system.add("robot.a", nets::alone, {}, 10ms);
    system.add("robot.b", nets::alone, counter, 10ms);
  };
  start();
  const json first = rest(1);
  EXPECT_FALSE(first.at("subsystems").at(0).contains("memory"));
  EXPECT_EQ(first.at("subsystems").at(1).at("memory").at(0), (json{{"name", "count"}, {"value", "0"}}));
  EXPECT_EQ(first.at("subsystems").at(1).at("memory").at(1), (json{{"name", "word"}, {"value", "\"\""}}))
      << "the map is too large";
  for (std::uint64_t step = 2; step < 6; ++step) {
    EXPECT_EQ(command({{"command", "step_iteration"}, {"subsystem", "robot.b"}}), "");
    const json line = rest(step);
    const json& subsystem = line.at("subsystems").at(1);
    EXPECT_EQ(subsystem.at("memory").at(0).at("value"),
              std::to_string(subsystem.at("iterations").get<int>()));
  }
  finish();
}

TEST_F(Controlled, ABreakpointPausesWhenItsPlaceGetsAToken) {
  options_.paused = false;
  options_.speed = 0.001;  // hardly begins
  start();
  const std::string place = "robot.b.run.in";
  EXPECT_EQ(command({{"command", "breakpoints"}, {"places", {place}}}), "");
  EXPECT_EQ(command({{"command", "speed"}, {"value", 0}}), "");
  EXPECT_EQ(rest(1).at("broke_at"), place);
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), place);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"places", json::array()}}), "");
  finish();
  EXPECT_EQ(summary_.ended, "duration");
}

TEST_F(Controlled, ABreakpointPausesWhenItsTransitionHasFired) {
  start();
  rest(1);
  const Instance& a = made_->instances[0];
  const std::string transition = "robot.a." + std::string(a.net->transitions[0].name);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"transitions", {transition}}}), "");
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), transition);
  std::string error;
  const std::optional<Recording> recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(recording->transitions[recording->entries.back().event.subject].name, transition);
  EXPECT_EQ(command({{"command", "breakpoints"}}), "");
  finish();
}

TEST_F(Controlled, ABreakpointPausesWhenItsConditionComesToHoldBeforeItFires) {
  start();
  rest(1);
  const auto& transitions = made_->instances[0].net->transitions;
  const auto decided = std::find_if(transitions.begin(), transitions.end(), [](const Transition& one) {
    return one.guard.kind == Guard::Kind::go_on || one.guard.kind == Guard::Kind::terminal;
  });
  ASSERT_NE(decided, transitions.end());
  const std::string transition = "robot.a." + std::string(decided->name);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"conditions", {transition}}}), "");
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), transition);
  const std::size_t before = firings_in(options_.recording);
  EXPECT_EQ(command({{"command", "breakpoints"}}), "");
  EXPECT_EQ(command({{"command", "step_firing"}}), "");
  rest(3);
  EXPECT_EQ(firings_in(options_.recording), before + 1);
  finish();
}

TEST_F(Controlled, CommandsThatMakeNoSenseAreAnsweredAndChangeNothing) {
  start();
  rest(1);
  for (const char* text :
       {R"({"command":"fly"})", R"({"command":3})", R"({"command":"speed"})",
        R"({"command":"speed","value":-1})", R"({"command":"speed","value":"x"})",
        R"({"command":"breakpoints","places":["nowhere"]})", R"({"command":"breakpoints","places":[1]})",
        R"({"command":"breakpoints","places":3})", R"({"command":"breakpoints","transitions":["nowhere"]})",
        R"({"command":"breakpoints","conditions":["robot.a"]})",
        R"({"command":"step_iteration","subsystem":"robot.z"})",
        R"({"command":"step_iteration","subsystem":[]})"})
    EXPECT_NE(command(json::parse(text)), "") << text;
  send_line("{\n[]\nnull\n\"x\"\n\xff");
  EXPECT_EQ(rest(1).at("pauses"), 1);
  finish();
}

}  // namespace
}  // namespace tessera::testing
