#include <gtest/gtest.h>

#include "carrier/control.hpp"

namespace depot::carrier::control {
namespace {

class Carrier : public ::testing::Test {
 protected:
  /// The position that the odometry reports now.
  void see(double x, double y = 0, double heading = 0, bool known = true) {
    in.place = Place{x, y, heading, known};
    in.place.valid = true;
    in.place.age = {};
  }
  [[nodiscard]] double line() const { return parameters.dock - parameters.line; }

  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

TEST_F(Carrier, TurnsBackAtTheLineWhileItWorks) {
  see(0.1);
  work(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, parameters.speed);
  EXPECT_LT(memory.charge, 1);
  see(line());
  work(context, in, memory, out);
  EXPECT_EQ(memory.way, -1);
  work(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, -parameters.speed);
}

TEST_F(Carrier, StandsStillWhileItAsks) {
  out.motion = {1, 1};
  ask(context, in, memory, out);
  EXPECT_EQ(static_cast<const Motion&>(out.motion), (Motion{0, 0}));
  EXPECT_TRUE(out.request);
}

TEST_F(Carrier, StandsStillAndHasNotArrivedIfItDoesNotKnowWhereItIsOrIsPaused) {
  see(line(), 0, 0, /*known=*/false);
  memory.to_go = -1;
  leave(context, in, memory, out);
  EXPECT_EQ(out.motion.ahead, 0);
  EXPECT_GT(memory.to_go, 0);
  see(line());
  in.wish = Wish{true};
  in.wish.valid = true;
  leave(context, in, memory, out);
  EXPECT_GT(memory.to_go, 0);
}

TEST_F(Carrier, SteersBackToItsLaneOnBothWays) {
  see(0.1, 0.1);
  enter(context, in, memory, out);
  EXPECT_LT(out.motion.turn, 0);
  see(parameters.dock, 0.1);
  leave(context, in, memory, out);
  EXPECT_GT(out.motion.turn, 0);
}

TEST_F(Carrier, IsFullAfterFourSecondsAtTheDock) {
  memory.charge = 0;
  for (int i = 0; i < 80; ++i) charge(context, in, memory, out);
  EXPECT_NEAR(memory.charge, 1, 1e-9);
}

}  // namespace
}  // namespace depot::carrier::control
