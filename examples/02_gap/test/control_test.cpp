#include "robot/control.hpp"

#include <gtest/gtest.h>

namespace gap::robot::control {
namespace {

class Search : public ::testing::Test {
 protected:
  Search() { context.period = std::chrono::milliseconds(50); }

  /// The line as seen last, before it was lost.
  void lose(const LineReading& seen) {
    in.line = seen;
    follow(context, in, memory, out);
    in.line = {false, false, false};
  }

  Parameters parameters;
  Context context{parameters};
  Inputs in;
  Memory memory;
  Outputs out;
};

TEST_F(Search, GoesStraightOnOverAGap) {
  lose({true, true, true});
  for (double driven = 0; driven < 0.04; driven += parameters.v * 0.05) {
    search(context, in, memory, out);
    EXPECT_EQ(static_cast<const Velocity&>(out.motion), (Velocity{parameters.v, 0}));
  }
}

TEST_F(Search, TurnsToTheSideWhereTheLineWasSeen) {
  for (const auto& [seen, angular] : {std::pair{LineReading{true, false, false}, -parameters.w},
                                      std::pair{LineReading{false, true, true}, parameters.w}}) {
    lose(seen);
    while (memory.searched < parameters.reach) search(context, in, memory, out);
    search(context, in, memory, out);
    EXPECT_EQ(out.motion.angular, angular);
  }
}

TEST_F(Search, StartsAfreshAfterTheLineWasFound) {
  lose({true, true, true});
  search(context, in, memory, out);
  EXPECT_GT(memory.searched, 0);
  lose({true, true, true});
  EXPECT_EQ(memory.searched, 0);
}

}  // namespace
}  // namespace gap::robot::control
