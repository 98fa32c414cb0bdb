#include "robot/control.hpp"

#include <gtest/gtest.h>

namespace line_follower::robot::control {
namespace {

struct Row {
  LineReading seen;
  double linear, angular;
};

// The table of the paper for v = 0.2 m/s and w = 3 rad/s.
const Row table[] = {
    {{true, true, true}, 0.2, 0},       {{true, true, false}, 0.2, -0.2},
    {{true, false, false}, 0.2, -3},    {{false, true, true}, 0.2, 0.2},
    {{false, false, true}, 0.2, 3},     {{false, false, false}, -0.2, -1.5},
    {{false, true, false}, -0.2, -1.5}, {{true, false, true}, -0.2, -1.5},
};

TEST(Follow, SteersByTheTable) {
  Parameters parameters;
  parameters.v = 0.2;
  parameters.w = 3;
  Context context(parameters);
  for (const Row& row : table) {
    SCOPED_TRACE(::testing::Message() << row.seen.left << row.seen.middle << row.seen.right);
    Inputs in;
    in.line = row.seen;
    Memory memory;
    Outputs out;
    follow(context, in, memory, out);
    EXPECT_DOUBLE_EQ(out.motion.linear, row.linear);
    EXPECT_DOUBLE_EQ(out.motion.angular, row.angular);
  }
}

TEST(Init, StandsStill) {
  const Parameters parameters;
  Context context(parameters);
  Memory memory;
  Outputs out;
  out.motion = {1, 1};
  init(context, Inputs{}, memory, out);
  EXPECT_EQ(static_cast<const Velocity&>(out.motion), (Velocity{0, 0}));
}

}  // namespace
}  // namespace line_follower::robot::control
