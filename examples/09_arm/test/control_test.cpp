#include "arm/control.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace arm_bench::arm::control {
namespace {

class Arm : public ::testing::Test {
 protected:
  /// The encoders say that the arm is where it was sent.
  void follow() {
    in.joints = memory.at;
    in.joints.valid = true;
    in.joints.age = {};
  }
  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

TEST_F(Arm, ComesToTheLeftAndGoesOnToTheRight) {
  follow();
  for (int step = 0; step < 200 && !memory.there; ++step) {
    left(context, in, memory, out);
    follow();
  }
  EXPECT_TRUE(memory.there);
  EXPECT_TRUE(memory.to_right);
  EXPECT_GT(memory.at.yaw, 0.5);
}

TEST_F(Arm, MovesNoFasterThanItIsAllowedTo) {
  follow();
  for (int step = 0; step < 100; ++step) {
    const double before = memory.at.yaw;
    right(context, in, memory, out);
    EXPECT_LE(std::abs(memory.at.yaw - before), parameters.speed * 0.02 + 1e-12);
    follow();
  }
}

TEST_F(Arm, StaysWhereItIsWhileTheEncodersAreSilent) {
  const Joints before = memory.at;
  for (int step = 0; step < 100; ++step) over(context, in, memory, out);
  EXPECT_FALSE(memory.there);
  EXPECT_EQ(memory.at, before);
}

}  // namespace
}  // namespace arm_bench::arm::control
