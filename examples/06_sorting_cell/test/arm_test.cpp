#include <gtest/gtest.h>

#include "arm/control.hpp"
#include "arm/geometry.hpp"

namespace sorting_cell::arm::control {
namespace {

/// The position of the cup for these angles; `up` is that above the floor.
void expect_reached(double reach, double up) {
  const Angles angles = angles_of(reach, up);
  const double bent = angles.shoulder + angles.elbow;
  const double out = upper_arm * std::cos(angles.shoulder) + fore_arm * std::cos(bent);
  const double height =
      shoulder_up - upper_arm * std::sin(angles.shoulder) - fore_arm * std::sin(bent) - hand;
  EXPECT_NEAR(out, reach, 1e-9);
  EXPECT_NEAR(height, up, 1e-9);
  EXPECT_NEAR(bent + angles.wrist, std::numbers::pi / 2, 1e-9) << "the cup points down";
}

TEST(Geometry, PutsTheCupWhereItIsToBe) {
  expect_reached(0.3, 0.17);
  expect_reached(0.25, 0.26);
  expect_reached(0.36, 0.078);
}

TEST(Geometry, ComesToTheGoalAndStaysThere) {
  double at = 0;
  for (int step = 0; step < 100; ++step) at = towards(0.3, at, 0.5, 0.02);
  EXPECT_EQ(at, 0.3);
  EXPECT_LT(towards(0.3, 0, 0.5, 0.02), 0.0101);
}

class Arm : public ::testing::Test {
 protected:
  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

/// An arm whose encoders say what was asked for gets there; one whose encoders are silent does not.
TEST_F(Arm, IsThereOnlyIfItsEncodersSayItIs) {
  wait(context, in, memory, out);
  in.order = Order{1, true, 0.01};
  for (int step = 0; step < 200; ++step) reach(context, in, memory, out);
  EXPECT_FALSE(memory.there);
  in.joints = static_cast<const Joints&>(out.goal);
  in.joints.valid = true;
  in.joints.age = {};
  reach(context, in, memory, out);
  EXPECT_TRUE(memory.there);
}

TEST_F(Arm, GivesTheBeltFreeOnceForEachBox) {
  free(context, in, memory, out);
  EXPECT_EQ(out.taken, 1U);
  give_up(context, in, memory, out);
  EXPECT_EQ(out.taken, 2U);
  EXPECT_EQ(out.suction, 0);
}

}  // namespace
}  // namespace sorting_cell::arm::control
