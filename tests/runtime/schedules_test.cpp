#include "run/schedules.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "firing_oracle.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

[[nodiscard]] ScheduleReport try_all(TestSystem& system, const RunOptions& options, std::uint64_t count) {
  std::string error;
  const std::optional<ScheduleReport> report = try_schedules(system.system(), options, count, error);
  EXPECT_TRUE(report) << error;
  return report.value_or(ScheduleReport{});
}

/// Two subsystems that write and read a variable outside the net in two steps: a race that only some
/// interleavings of their firings show.
struct Race : ::testing::Test {
  TestSystem system;
  int holder = 0;
  Race() {
    for (const int self : {1, 2}) {
      Script script;
      script.call = [this, self](ScriptState& state) {
        state.context.assert_that(holder == 0 || holder == self, "{} takes what {} holds", self, holder);
        holder = self;
      };
      script.decide = [this](const ScriptState&) {  // at the end of the iteration
        holder = 0;
        return Outcome::go_on;
      };
      system.add(self == 1 ? "robot.a" : "robot.b", nets::alone, script, 10ms);
    }
  }
};

TEST(Schedules, OfASystemWithoutRacesAllEndWell) {
  TestSystem system;
  Script counts;
  counts.call = [](ScriptState& state) { state.context.assert_that(true, "always"); };
  const auto a = system.add("robot.a", nets::nb_sender, counts, 10ms);
  const auto b = system.add("robot.b", nets::nb_receiver, {}, 10ms);
  system.connect(a, "x", b, "x", buffered);
  RunOptions options = simulated(100ms);
  options.seed = 5;
  const ScheduleReport report = try_all(system, options, 20);
  EXPECT_FALSE(report.failed);
  EXPECT_EQ(report.tried, 20u);
  EXPECT_EQ(report.simulated, 2s);
  EXPECT_GT(report.firings, 20u * 10 * 8);
  EXPECT_TRUE(schedules_line(report).starts_with("20 of 20 schedules from seed 5 on, none fails"));
}

TEST(Schedules, AnEntryOfNextThatIsMissingFailsTheFirst) {
  TestSystem system;
  Script script;
  script.decide = [](const ScriptState&) { return Outcome::error; };
  script.route = [](const ScriptState&, bool) { return -1; };
  system.add("robot.a", nets::two_behaviours, script, 10ms);
  const ScheduleReport report = try_all(system, simulated(100ms), 20);
  ASSERT_TRUE(report.failed);
  EXPECT_EQ(report.tried, 1u);
  EXPECT_EQ(report.failed->seed, 1u);
  const auto json = nlohmann::json::parse(schedules_json(report));
  EXPECT_EQ(json.at("failure").at("seed"), 1);
  EXPECT_EQ(json.at("failure").at("ended"), "stopped: robot.a: no condition of `next` holds");
}

TEST(Schedules, AHangIsAFailure) {
  TestSystem system;
  const auto a = system.add("robot.waits", nets::b_receiver, {});
  system.connect(a, "", a, "x", buffered);  // nobody sends
  const ScheduleReport report = try_all(system, simulated(100ms), 3);
  ASSERT_TRUE(report.failed);
  EXPECT_NE(report.failed->summary.ended.find("nothing can ever happen again"), std::string::npos);
}

TEST_F(Race, IsFoundOnlyByInterleavingAndTheSeedMakesItAgain) {
  RunOptions options = simulated(1s);
  EXPECT_FALSE(run(system, options).failed) << "an iteration that waits for nothing is never interrupted";
  const ScheduleReport report = try_all(system, options, 100);
  ASSERT_TRUE(report.failed);
  EXPECT_NE(report.failed->summary.ended.find("broken assertion: "), std::string::npos);

  holder = 0;
  options.interleave = true;
  options.seed = report.failed->seed;
  options.recording = scratch_file("again");
  const RunSummary again = run(system, options);
  EXPECT_TRUE(again.failed);
  EXPECT_EQ(again.ended, report.failed->summary.ended);
  EXPECT_EQ(again.simulated, report.failed->summary.simulated);
  EXPECT_EQ(again.firings, report.failed->summary.firings);
}

}  // namespace
}  // namespace tessera::testing
