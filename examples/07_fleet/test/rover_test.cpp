#include <gtest/gtest.h>

#include <algorithm>

#include "rover/control.hpp"

namespace fleet::rover::control {
namespace {

class Rover : public ::testing::Test {
 protected:
  Rover() { see(3); }
  /// The same distance all around, and now.
  void see(float distance) {
    in.scan.ranges.fill(distance);
    in.scan.known = true;
    in.scan.valid = true;
    in.scan.age = {};
  }
  /// A distance between two angles, in 32nds of a circle from the right of straight ahead (16) on.
  void see(int from, int to, float distance) {
    std::fill(in.scan.ranges.begin() + from, in.scan.ranges.begin() + to, distance);
  }

  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

TEST_F(Rover, DrivesWhereThereIsRoom) {
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, parameters.speed);
  EXPECT_EQ(memory.side, 1);
  EXPECT_GT(memory.free, 1);
}

TEST_F(Rover, StopsBeforeSomethingAndTurnsToTheSideWithMoreRoom) {
  see(15, 18, 0.2F);
  see(8, 15, 1);  // the right
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  EXPECT_LE(memory.free, 0);
  avoid(context, in, memory, out);
  EXPECT_GT(out.motion.turn, 0);
  see(8, 15, 3);
  see(18, 25, 1);  // the left
  drive(context, in, memory, out);
  avoid(context, in, memory, out);
  EXPECT_LT(out.motion.turn, 0);
}

TEST_F(Rover, StopsForWhatIsBesideItButNotForWhatIsBehind) {
  see(9, 11, 0.2F);
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  see(3);
  see(0, 4, 0.2F);
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, parameters.speed);
}

TEST_F(Rover, StandsStillWithoutAScanOrWithAnOldOne) {
  in.scan.age = std::chrono::seconds(1);
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  see(3);
  in.scan.valid = false;
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  see(3);
  in.scan.known = false;  // the laser is silent
  drive(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
}

TEST_F(Rover, CountsItselfAndStandsMeanwhile) {
  in.call = 3;
  out.motion = {1, 1};
  answer(context, in, memory, out);
  EXPECT_EQ(static_cast<const Motion&>(out.motion), (Motion{0, 0}));
  EXPECT_EQ(memory.answered, 3U);
  in.counted = Count{4, 10.5};
  memory.driven = 2;
  pass_on(context, in, memory, out);
  EXPECT_EQ(static_cast<const Count&>(out.count), (Count{5, 12.5}));
}

}  // namespace
}  // namespace fleet::rover::control
