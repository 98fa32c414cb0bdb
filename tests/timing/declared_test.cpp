// Bounds of specifications: the line follower of docs/theory/timing.md and its alternatives, fleets, and what is missing.
#include <gtest/gtest.h>

#include <string>

#include "follower.hpp"

namespace tessera::timing {
namespace {

struct Case {
  std::string what;
  Follower follower;
  Time age, reaction;
};

TEST(Declared, TheLineFollowerAndItsAlternativesHaveTheseBounds) {
  const std::string waits = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }";
  const std::string motion_waits =
      "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: blocking }";
  Follower shared;
  const std::string processor = ", realtime: { cpu: 0, priority: ";
  shared.sensor += processor + "53 }";
  shared.control += processor + "51 }";
  shared.motor += processor + "52 }";
  for (const Case& one : {
           Case{"as it is", {}, 82 * ms, 142 * ms},
           Case{"the motor does not wait",
                {.motion = "robot.control.motion -> robot.motor.motion"},
                142 * ms,
                162 * ms},
           Case{
               "the motor has no rate", {.motor = "stale: never", .motion = motion_waits}, 80 * ms, 130 * ms},
           Case{"control and motor are driven by events",
                {.control = "memory: {}", .motor = "stale: never", .line = waits, .motion = motion_waits},
                18 * ms,
                32 * ms},
           Case{"a timeout that may fire",
                {.motion = "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: blocking, "
                           "timeout: 30 ms }"},
                150 * ms - 1,
                172 * ms - 2},
           Case{"one processor", shared, 104 * ms, 144 * ms},
       }) {
    SCOPED_TRACE(one.what);
    const Judged judged(one.follower);
    ASSERT_TRUE(judged.reading.model) << judged.reading.report();
    ASSERT_EQ(judged.verdicts.size(), 1U);
    EXPECT_EQ(judged.declared.chains[0].name, "robot.sensor -> robot.control -> robot.motor");
    EXPECT_EQ(judged.verdicts[0].why, "");
    EXPECT_EQ(judged.verdicts[0].bound.age, one.age);
    EXPECT_EQ(judged.verdicts[0].bound.reaction, one.reaction);
  }
}

TEST(Declared, OnlyChainsWithoutWaitsAreExact) {
  EXPECT_FALSE(Judged({}).verdicts.at(0).exact);
  EXPECT_TRUE(Judged({.motion = "robot.control.motion -> robot.motor.motion"}).verdicts.at(0).exact);
}

TEST(Declared, ChainsWithoutABoundSayWhy) {
  const Judged silent({.sensor_takes = ""});
  ASSERT_TRUE(silent.reading.model) << silent.reading.report();
  EXPECT_EQ(silent.verdicts.at(0).why, "robot.sensor.look does not say what it takes");
  EXPECT_GE(silent.verdicts.at(0).bound.age, unbounded);

  const Judged first({.control = "rate: 20 Hz, receive: first"});
  ASSERT_TRUE(first.reading.model) << first.reading.report();
  EXPECT_EQ(first.verdicts.at(0).why,
            "robot.control receives before its transition function (`receive: first`)");
}

TEST(Declared, EachMemberOfAFleetHasItsChain) {
  Follower fleet{.count = "    count: 1000\n"};
  for (std::string* const channel : {&fleet.line, &fleet.motion})
    for (std::size_t at = 0; (at = channel->find("robot.", at)) != std::string::npos; at += 9)
      channel->replace(at, 6, "robot[i].");
  const Judged judged(fleet);
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  ASSERT_EQ(judged.verdicts.size(), 1000U);
  for (const ChainVerdict& verdict : judged.verdicts) {
    EXPECT_EQ(verdict.bound.age, 82 * ms);
    EXPECT_EQ(verdict.bound.reaction, 142 * ms);
  }
}

}  // namespace
}  // namespace tessera::timing
