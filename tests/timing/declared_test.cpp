// Bounds of specifications: the line follower of docs/theory/timing.md and its alternatives, fleets, and what is missing.
#include "timing/declared.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "../spec/spec_reading.hpp"

namespace tessera::timing {
namespace {

constexpr Time ms = 1'000'000;

/// The line follower. The parts that an alternative changes are arguments.
struct Follower {
  std::string sensor = "rate: 50 Hz", control = "rate: 20 Hz", motor = "rate: 50 Hz";
  std::string line = "robot.sensor.line -> robot.control.line";
  std::string motion =
      "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: blocking, timeout: 200 ms }";
  std::string sensor_takes = "takes: 1..2 ms,", count;

  [[nodiscard]] std::string text() const {
    return "tessera: 1\nsystem: demo\nagents:\n  robot:\n" + count + "    control: { " + control +
           ", inputs: { line: float64 }, outputs: { motion: float64 },\n"
           "      behaviours: { follow: { takes: 2..8 ms, next: follow } } }\n"
           "    receptors: { sensor: { " +
           sensor +
           ", real: { light: float64 }, outputs: { line: float64 },\n"
           "      behaviours: { look: { " +
           sensor_takes +
           " next: look } } } }\n"
           "    effectors: { motor: { " +
           motor +
           ", inputs: { motion: float64 }, real: { speed: float64 },\n"
           "      behaviours: { drive: { takes: 1..2 ms, next: drive } } } }\n"
           "channels:\n  - " +
           line + "\n  - " + motion + "\n";
  }
};

struct Judged {
  explicit Judged(const Follower& follower) : reading(follower.text()) {
    if (!reading.model) return;
    declared = timing::declared(*reading.model);
    const Bounds bounds(declared.system);
    for (const DeclaredChain& chain : declared.chains)
      verdicts.push_back(judge(declared, *reading.model, bounds, chain));
  }
  spec::Reading reading;
  Declared declared;
  std::vector<ChainVerdict> verdicts;
};

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
