#include "sim/engine/physics.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "sim/engine/elements.hpp"
#include "world_library.hpp"

namespace tessera::sim {
namespace {

struct Bits {
  std::uint64_t x, y, heading;
  friend bool operator==(const Bits&, const Bits&) = default;
};

/// The pose of a turning robot after five seconds.
[[nodiscard]] Bits driven(bool read_at_every_step) {
  auto loaded = Physics::load(line_world());
  if (!loaded) throw std::runtime_error(loaded.problem());
  const auto physics = std::move(*loaded);
  physics->place_robot({{1, 2}, 0.5});
  const int left = *find_element(physics->model(), mjOBJ_ACTUATOR, "", "wheel_left"),
            right = *find_element(physics->model(), mjOBJ_ACTUATOR, "", "wheel_right");
  const int eye = *find_element(physics->model(), mjOBJ_SITE, "", "eye_left");
  for (int step = 0; step < 2500; ++step) {
    physics->command(left, 5 + step % 700 * 0.01);
    physics->command(right, 8 - step % 900 * 0.01);
    physics->step();
    if (!read_at_every_step) continue;
    EXPECT_TRUE(physics->robot());
    static_cast<void>(physics->site_position(eye));
  }
  EXPECT_FALSE(physics->failure());
  const Pose pose = *physics->robot();
  return {std::bit_cast<std::uint64_t>(pose.at.x_m), std::bit_cast<std::uint64_t>(pose.at.y_m),
          std::bit_cast<std::uint64_t>(pose.heading_rad)};
}

TEST(Physics, ReadingDoesNotDisturbASingleBit) { EXPECT_EQ(driven(true), driven(false)); }

TEST(Physics, DevicesAreOnTheBodyThatIsAttachedToTheWorld) {
  auto loaded = Physics::load(line_world());
  ASSERT_TRUE(loaded) << loaded.problem();
  const auto physics = std::move(*loaded);
  const Physics::RootBody root =
      physics->root_of_site(*find_element(physics->model(), mjOBJ_SITE, "", "eye_right"));
  EXPECT_EQ(physics->name(root), "robot");
  EXPECT_EQ(physics->root_of_actuator(*find_element(physics->model(), mjOBJ_ACTUATOR, "", "wheel_left")),
            root);
}

}  // namespace
}  // namespace tessera::sim
