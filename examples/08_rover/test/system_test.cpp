#include <gtest/gtest.h>

#include "tessera_testing.hpp"

namespace base = scout::robot::base;
namespace control = scout::robot::control;
namespace laser = scout::robot::laser;
using namespace std::chrono_literals;

namespace {

/// A scan of a round room.
scout::Scan room(float radius_m) {
  scout::Scan scan{.ranges = {}, .known = true};
  scan.ranges.fill(radius_m);
  return scan;
}

// One iteration: the function, and then the conditions of the specification.
TEST(Drive, IsFollowedByAvoidBeforeAWall) {
  tessera::SubsystemUnderTest<control::Context> robot;
  robot.receive(robot.in.scan, room(3));
  EXPECT_EQ(robot.iterate("drive"), "drive");
  robot.receive(robot.in.scan, room(0.2F));
  EXPECT_EQ(robot.iterate("drive"), "avoid");
  EXPECT_EQ(robot.out.motion.ahead, 0);
}

// A laser that fails: its last scan stays, and gets older.
TEST(Drive, StandsStillAfterALaserThatFails) {
  tessera::SubsystemUnderTest<control::Context> robot;
  robot.receive(robot.in.scan, room(3));
  robot.receive_invalid(robot.in.scan);
  EXPECT_EQ(robot.iterate("drive"), "avoid");
  EXPECT_EQ(robot.out.motion.ahead, 0);
}

// A condition alone.
TEST(Avoid, EndsWhereThereIsRoom) {
  tessera::SubsystemUnderTest<control::Context> robot;
  robot.memory.free = 0.1;
  EXPECT_EQ(robot.outcome("avoid"), tessera::Outcome::go_on);
  robot.memory.free = 0.2;
  EXPECT_EQ(robot.outcome("avoid"), tessera::Outcome::terminal);
  EXPECT_EQ(robot.fail("avoid"), "avoid");  // an error: the entry of `next` for it comes first
}

// The whole system in simulated time, with a laser that follows a script.
TEST(System, TurnsAwayFromAWallThatAppears) {
  tessera::SystemUnderTest rover(tessera::generated_system());
  rover.script<laser::Context>(
      [](auto& laser) { laser.out.scan = room(laser.context.now < tessera::Time(1s) ? 3 : 0.2F); });
  double ahead = 0;
  rover.observe<base::Context>([&](auto& base) { ahead = base.out.command.ahead; });
  EXPECT_FALSE(rover.run(2s).failed);
  // Before its first scan, the rover knows no free space either.
  EXPECT_EQ(rover.behaviours("robot.control"),
            (std::vector<std::string>{"drive", "avoid", "drive", "avoid"}));
  EXPECT_EQ(ahead, 0);
}

// The device itself is scripted: the user's receptor reads it.
TEST(Laser, PassesOnWhatTheDeviceSaw) {
  tessera::SystemUnderTest rover(tessera::generated_system());
  rover.sense<std::array<float, 32>>("robot.laser.ranges", [] { return room(0.2F).ranges; });
  ASSERT_FALSE(rover.run(1s).failed);
  EXPECT_EQ(rover.behaviours("robot.control").back(), "avoid");
  EXPECT_THROW(rover.sense<double>("robot.laser.ranges", [] { return 1.0; }), std::invalid_argument);
  EXPECT_THROW(rover.behaviours("robot.nobody"), std::invalid_argument);
}

}  // namespace
