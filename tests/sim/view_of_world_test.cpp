// The world's state as drivers see it that are C++ classes.

#include <gtest/gtest.h>

#include <cmath>

#include "small_worlds.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

TEST(ViewOfWorld, ShowsWhatDevicesShow) {
  const auto world = open_text("view", workshop);
  const auto view = world->state("a");
  ASSERT_NE(view, nullptr);
  view->command("shoulder", 1);
  world->advance_to(Time(2s));
  EXPECT_EQ(view->time(), 2s);
  EXPECT_EQ(view->sensor("shoulder"), view->joint_position("shoulder"));
  EXPECT_NEAR(view->joint_position("shoulder")[0], 1, 0.02);
  EXPECT_EQ(view->joint_velocity("swing").size(), 3U);
  EXPECT_NEAR(view->body("hand").position_m[1], 0.3 * std::sin(view->joint_position("shoulder")[0]), 1e-3);
  EXPECT_NEAR(view->site("tip").position_m[2], 0.5, 1e-3);
  EXPECT_TRUE(view->touch("box", "world"));
  EXPECT_FALSE(view->touch("box", "arm"));
}

TEST(ViewOfWorld, PushesBodies) {
  const auto world = open_text("push", workshop);
  world->state("a")->push("box", {0, 0, 30});
  world->advance_to(Time(500ms));
  EXPECT_GT(world->state("a")->body("box").position_m[2], 1);
}

TEST(ViewOfWorld, SaysWhatIsNotThere) {
  const auto world = open_text("absent", workshop);
  const auto view = world->state("a");
  try {
    static_cast<void>(view->body("boxx"));
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_STREQ(
        error.what(),
        "the world has no body 'boxx'; did you mean 'box'? the world has: world, arm, hand, box, lamp, "
        "gate");
  }
  EXPECT_THROW(view->command("shoulder", std::nan("")), WorldError);
  EXPECT_THROW(view->command("elbow", 1), WorldError);
}

}  // namespace
}  // namespace tessera::testing
