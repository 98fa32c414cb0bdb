#include <gtest/gtest.h>

#include "tessera_testing.hpp"

namespace odometry = depot::carrier::odometry;
using namespace std::chrono_literals;

// One carrier drives until its battery is low, and is at the line after six seconds: the script says so to its
// odometry. The others do not know where they are, so they stand still.
TEST(System, TheDockIsLentToTheCarrierThatAsks) {
  tessera::SystemUnderTest system(tessera::generated_system());
  system.script<odometry::Context>([](auto& odometry) { odometry.out.place = {0, 0, 0, false}; });
  int iterations = 0;
  system.script<odometry::Context>(
      [&](auto& odometry) {
        odometry.out.place = {++iterations < 300 ? 0.3 : 0.7, 0, 0, true};
      },
      "carrier[0].odometry");
  EXPECT_FALSE(system.run(8s).failed);
  EXPECT_EQ(system.behaviours("carrier[0].control"),
            (std::vector<std::string>{"work", "to_line", "ask", "enter"}));
  EXPECT_EQ(system.behaviours("carrier[1].control"), std::vector<std::string>{"work"});
}
