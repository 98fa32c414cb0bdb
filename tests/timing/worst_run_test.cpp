// The runs that reach the bounds.
#include "timing/worst/worst_run.hpp"

#include <gtest/gtest.h>

#include <string>

#include "follower.hpp"

namespace tessera::timing {
namespace {

struct Alternative {
  std::string what;
  Follower follower;
  Time age, reaction;
  bool reaches = true;
};

TEST(WorstRun, OfTheLineFollowerAndItsAlternativesReachesTheBounds) {
  const std::string waits = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }";
  const std::string motion_waits =
      "{ from: \"robot.control.motion\", to: \"robot.motor.motion\", receive: blocking }";
  Follower shared;
  const std::string processor = ", realtime: { cpu: 0, priority: ";
  shared.sensor += processor + "53 }";
  shared.control += processor + "51 }";
  shared.motor += processor + "52 }";
  for (const Alternative& one : {
           Alternative{"as it is", {}, 82 * ms, 142 * ms},
           Alternative{"the motor does not wait",
                       {.motion = "robot.control.motion -> robot.motor.motion"},
                       142 * ms,
                       162 * ms},
           Alternative{
               "the motor has no rate", {.motor = "stale: never", .motion = motion_waits}, 80 * ms, 130 * ms},
           Alternative{
               "control and motor are driven by events",
               {.control = "memory: {}", .motor = "stale: never", .line = waits, .motion = motion_waits},
               18 * ms,
               32 * ms},
           Alternative{"one processor", shared, 84 * ms, 124 * ms, false},
       }) {
    SCOPED_TRACE(one.what);
    const Judged judged(one.follower);
    ASSERT_TRUE(judged.reading.model) << judged.reading.report();
    const Bounds bounds(judged.declared.system);
    WorstRunSearch search(judged.declared, bounds);
    const WorstRuns runs = search.find(judged.declared.chains[0]);
    ASSERT_TRUE(runs.age && runs.reaction);
    EXPECT_EQ(runs.age->time(), one.age);
    EXPECT_EQ(runs.reaction->time(), one.reaction);
    EXPECT_EQ(runs.age->reaches, one.reaches);
    EXPECT_EQ(runs.reaction->reaches, one.reaches);
  }
}

}  // namespace
}  // namespace tessera::timing
