// The line follower of the paper in a scene, through the same interface as in a world of MuJoCo
// (tests/sim/follow_test.cpp). The robot of the test's server has no inertia, so this shows the way of
// readings and commands, not CoppeliaSim's physics.
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <stdexcept>

#include "../environment.hpp"
#include "follower.hpp"
#include "scene_server.hpp"
#include "sim/track.hpp"
#include "world_library.hpp"

namespace tessera::testing {
namespace {

sim::LineMetrics follow(const Follower& follower, const sim::Pose& start, double step_s) {
  const std::string oval = shipped_track("oval.png");
  SceneServer server({.track = oval, .start = start, .step_s = step_s});
  std::string error;
  const auto world = open_world({.server = server.address()}, error);
  if (!world) throw std::runtime_error(error);
  drive(follower, *world, /*for_s=*/60);
  if (!world->finish(error)) throw std::runtime_error(error);
  const auto track = sim::Track::load(oval, 0.005);
  if (!track) throw std::runtime_error(track.problem());
  return measure(skeleton(*track), server.trace());
}

TEST(FollowInCoppelia, KeepsToTheOvalBothWaysRound) {
  constexpr std::array headings_rad{0.0, std::numbers::pi}, steps_s{0.05, 0.01};
  for (const double heading_rad : share_of(headings_rad))
    for (const double step_s : share_of(steps_s)) {
      const sim::LineMetrics metrics =
          follow({.sensor_delay_ms = 10, .motor_delay_ms = 10}, {{1.2, 0.1}, heading_rad}, step_s);
      SCOPED_TRACE(std::to_string(heading_rad) + " rad, steps of " + std::to_string(step_s) + " s");
      EXPECT_GT(metrics.laps, 1.5);
      EXPECT_LT(metrics.longest_loss_s, 0.5);
      EXPECT_LT(metrics.max_error_m, 0.06);
    }
}

}  // namespace
}  // namespace tessera::testing
