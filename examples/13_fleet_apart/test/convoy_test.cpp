#include <gtest/gtest.h>

#include "rover/control.hpp"
#include "supervisor/control.hpp"

namespace convoy {
namespace {

class Rover : public ::testing::Test {
 protected:
  Rover() {
    in.ahead.valid = true;
    context.index = 3;  // at -8 m
  }

  rover::control::Parameters parameters;
  rover::control::Context context{parameters};
  rover::control::Inputs in;
  rover::control::Memory memory;
  rover::control::Outputs out;
};

TEST_F(Rover, DrivesFasterTheFurtherTheOneAheadIs) {
  in.ahead = State{-5.5, 0};
  follow(context, in, memory, out);
  EXPECT_DOUBLE_EQ(out.speed, 0.5);
  EXPECT_DOUBLE_EQ(out.state.at, -8 + 0.025);
  in.ahead = State{10, 0};
  follow(context, in, memory, out);
  EXPECT_DOUBLE_EQ(out.speed, 1);
}

TEST_F(Rover, KeepsItsDistanceAndStandsIfItKnowsNothingOfTheOneAhead) {
  in.ahead = State{-6.5, 0};
  follow(context, in, memory, out);
  EXPECT_EQ(out.speed, 0);
  in.ahead = State{10, 0};
  in.ahead.valid = false;
  follow(context, in, memory, out);
  EXPECT_EQ(out.speed, 0);
  stand(context, in, memory, out);
  EXPECT_EQ(out.state.at, -8);
}

TEST(Supervisor, LeadsOnAndStopsAllIfTheLastOneIsNotHeardOf) {
  const supervisor::control::Parameters parameters;
  supervisor::control::Context context(parameters);
  supervisor::control::Inputs in;
  supervisor::control::Memory memory;
  supervisor::control::Outputs out;
  in.last = State{-98, 0};
  in.last.valid = true;
  lead(context, in, memory, out);
  EXPECT_DOUBLE_EQ(out.lead.at, parameters.pace * 0.05);
  EXPECT_DOUBLE_EQ(memory.length, 98 + out.lead.at);
  EXPECT_TRUE(out.go);
  in.last.disconnected = true;
  wait(context, in, memory, out);
  EXPECT_EQ(out.lead.speed, 0);
  EXPECT_FALSE(out.go);
}

}  // namespace
}  // namespace convoy
