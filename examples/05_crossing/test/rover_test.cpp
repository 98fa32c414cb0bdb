#include <gtest/gtest.h>

#include <numbers>

#include "rover/control.hpp"

namespace crossroads::rover::control {
namespace {

class Rover : public ::testing::Test {
 protected:
  /// The position that the odometry reports now.
  void see(double x, double y = 0, double heading = 0, bool known = true) {
    in.place = Place{x, y, heading, known};
    in.place.valid = true;
    in.place.age = {};
  }

  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

TEST_F(Rover, StopsAtTheLineAndTakesANumber) {
  see(0);
  approach(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, parameters.speed);
  EXPECT_GT(memory.to_go, 0);
  see(parameters.lane - parameters.stop);
  approach(context, in, memory, out);
  EXPECT_LE(memory.to_go, 0);
  EXPECT_EQ(out.motion.ahead, 0);
  EXPECT_EQ(out.request, 1U);
  EXPECT_EQ(out.back, 1U);
}

TEST_F(Rover, StandsStillWhileItWaits) {
  out.motion = {1, 1};
  wait(context, in, memory, out);
  EXPECT_EQ(static_cast<const Motion&>(out.motion), (Motion{0, 0}));
}

TEST_F(Rover, StandsStillAndHasNotArrivedIfItDoesNotKnowWhereItIs) {
  memory.to_go = -1;  // it has just come to the stop line
  see(parameters.lane, 0, 0, /*known=*/false);
  cross(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  EXPECT_GT(memory.to_go, 0);
}

TEST_F(Rover, SteersBackToItsLaneOnBothWays) {
  see(0, 0.1);
  leave(context, in, memory, out);
  EXPECT_LT(out.motion.turn, 0);
  memory.way = -1;
  see(1, 0.1, std::numbers::pi);
  leave(context, in, memory, out);
  EXPECT_GT(out.motion.turn, 0);
}

TEST_F(Rover, TurnsAtTheEndOfItsLane) {
  see(2 * parameters.lane);
  leave(context, in, memory, out);
  EXPECT_EQ(memory.way, -1);
  turn(context, in, memory, out);
  EXPECT_GT(out.motion.turn, 0);
  EXPECT_GT(memory.to_turn, 3);
  see(2 * parameters.lane, 0, std::numbers::pi);
  turn(context, in, memory, out);
  EXPECT_NEAR(memory.to_turn, 0, 1e-12);
  EXPECT_EQ(static_cast<const Motion&>(out.motion), (Motion{0, 0}));
}

}  // namespace
}  // namespace crossroads::rover::control
