#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tessera/controller.hpp>

#include "drivers.hpp"
#include "errands.hpp"
#include "system.hpp"
#include "tessera_testing.hpp"
#include "walks.hpp"

namespace features {
namespace {

using namespace std::chrono_literals;

// execute() computes the hash of the net from the generated tables and refuses another one than was verified.
TEST(System, ExecutesTheVerifiedNetForASecond) {
  tessera::RunOptions options;
  options.duration = 1s;
  std::string error;
  const std::optional<tessera::RunSummary> summary = tessera::execute(system(), options, error);
  ASSERT_TRUE(summary) << error;
  EXPECT_FALSE(summary->failed) << summary->ended;
  EXPECT_EQ(summary->simulated, 1s);
  ASSERT_EQ(summary->subsystems.size(), 12U);
  for (const tessera::RunSummary::PerSubsystem& each : summary->subsystems) {
    EXPECT_GT(each.iterations, 10U) << each.path;
    EXPECT_EQ(each.errors, 0U) << each.path;
  }
}

TEST(System, MovesValuesOfAllTypesThroughItsChannels) {
  tessera::RunOptions options;
  options.duration = 500ms;
  std::string error;
  devices::PoseSink::commands.clear();
  ASSERT_TRUE(tessera::execute(system(), options, error)) << error;
  const std::vector<Pose>& poses = devices::PoseSink::commands;
  EXPECT_GT(poses.size(), 15U);
  // x from the lidar through an array, y from the parameter of a walker through its report.
  EXPECT_TRUE(std::ranges::any_of(
      poses, [](const Pose& pose) { return pose.x > 9 && pose.x < 10 && pose.y == 0.1F; }));
}

TEST(System, MovesSequencesOfVaryingLengthThroughItsChannels) {
  tessera::RunOptions options;
  options.duration = 1s;
  std::string error;
  devices::PoseSink::commands.clear();
  ASSERT_TRUE(tessera::execute(system(), options, error)) << error;
  std::set<double> lengths;
  for (const Pose& pose : devices::PoseSink::commands) lengths.insert(pose.heading);
  EXPECT_FALSE(lengths.contains(-1)) << "two sequences of one value have lengths that do not agree";
  EXPECT_TRUE(lengths.contains(0));
  EXPECT_GE(lengths.size(), 3U);
}

TEST(System, GivesNumbersThatAreNotFiniteWhereTheyAreAllowed) {
  tessera::RunOptions options;
  options.duration = 500ms;
  std::string error;
  devices::JointSink::commands.clear();
  const auto summary = tessera::execute(system(), options, error);
  ASSERT_TRUE(summary) << error;
  EXPECT_FALSE(summary->failed) << summary->ended;
  const auto& safe = devices::JointSink::commands.back();
  EXPECT_TRUE(std::isnan(safe[0]));
  EXPECT_EQ(safe[1], 0);
  EXPECT_EQ(safe[2], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::ranges::any_of(devices::JointSink::commands, [](const auto& joints) {
    return std::isnan(joints[0]) && joints[1] == 2 && joints[2] == 3;
  })) << "a command, whose limit NaN does not break";
}

TEST(System, EndsWithTheSafeCommands) {
  tessera::RunOptions options;
  options.duration = 500ms;
  std::string error;
  ASSERT_TRUE(tessera::execute(system(), options, error)) << error;
  ASSERT_FALSE(devices::PoseSink::commands.empty() || devices::Grip::commands.empty());
  EXPECT_EQ(devices::Grip::commands.back(), 0.1F) << "the safe command of the specification";
  EXPECT_EQ(devices::PoseSink::commands.back(), Pose{})
      << "zero, where the specification gives no safe command";
}

// `rest` ends by memory.count, which is stored after a cell of type Part: conditions and functions
// must agree on its address.
TEST(System, ConditionsSeeTheMemoryThatFunctionsWrite) {
  tessera::RunOptions options;
  options.duration = 1s;
  std::string error;
  walks_after_a_rest = 0;
  ASSERT_TRUE(tessera::execute(system(), options, error)) << error;
  EXPECT_GT(walks_after_a_rest, 10);
}

// An answer of the office out of order never reaches a condition: that errand is late, and is cancelled.
TEST(System, TellsTheLifeOfAGoal) {
  tessera::RunOptions options;
  options.duration = 4s;
  std::string error;
  ends_of_errands.clear();
  served_errands.clear();
  const auto summary = tessera::execute(system(), options, error);
  ASSERT_TRUE(summary) << error;
  ASSERT_GT(ends_of_errands.size(), 20U);
  for (std::size_t index = 0; index < ends_of_errands.size(); ++index) {
    const EndOfErrand& end = ends_of_errands[index];
    EXPECT_EQ(end.call, index + 1) << "each errand has the next number";
    constexpr std::array<const char*, 5> behaviours{"report", "arrive", "report", "report", "stop"};
    constexpr std::array<const char*, 5> states{"gone", "succeeded", "rejected", "aborted", "executing"};
    EXPECT_EQ(end.behaviour, behaviours[end.call % 5]) << end.call;
    EXPECT_EQ(end.state, states[end.call % 5]) << end.call;
    EXPECT_EQ(end.cancels, end.call % 5 == 4) << "what has ended is not cancelled";
  }
  for (std::size_t index = 0; index < served_errands.size(); ++index)
    EXPECT_EQ(served_errands[index], index + 1) << "the office sees each of them, once";
}

TEST(System, TellsOneSubsystemAloneOfItsGoal) {
  tessera::SubsystemUnderTest<courier::control::Context> courier;
  EXPECT_EQ(courier.memory.going.view(), "ordered");
  EXPECT_EQ(courier.iterate("go"), "go");
  courier.tell("going", tessera::GoalState::aborted);
  EXPECT_EQ(courier.iterate("go"), "report");
  EXPECT_EQ(courier.iterate("report"), "go");
  EXPECT_EQ(courier.memory.going.view(), "ordered");
  EXPECT_THROW(courier.tell("gone", tessera::GoalState::gone), std::invalid_argument);
}

TEST(System, RefusesTablesOfAnotherNet) {
  tessera::System other = system();
  const auto shorter = other.channels.first(other.channels.size() - 1);
  other.channels = shorter;
  std::string error;
  EXPECT_FALSE(tessera::execute(other, {}, error));
  EXPECT_FALSE(error.empty());
}

}  // namespace
}  // namespace features
