#include <gtest/gtest.h>

#include "tessera_testing.hpp"

namespace odometry = crossroads::rover::odometry;
using namespace std::chrono_literals;

// One rover drives to the line, the other stays where it is: the scripts say so to their odometry.
TEST(System, TheCrossingIsLentToTheRoverThatIsAtTheLine) {
  tessera::SystemUnderTest system(tessera::generated_system());
  double x = 0;
  system.script<odometry::Context>(
      [&](auto& odometry) {
        odometry.out.place = {x += 0.01, 0, 0, true};
      },
      "robot[0].odometry");
  system.script<odometry::Context>(
      [](auto& odometry) {
        odometry.out.place = {0, 0, 0, true};
      },
      "robot[1].odometry");
  EXPECT_FALSE(system.run(2s).failed);
  EXPECT_EQ(system.behaviours("robot[0].control"), (std::vector<std::string>{"approach", "wait", "cross"}));
  EXPECT_EQ(system.behaviours("robot[1].control"), std::vector<std::string>{"approach"});
  EXPECT_EQ(system.behaviours("crossing.control"), (std::vector<std::string>{"watch", "lend_0"}));
}
