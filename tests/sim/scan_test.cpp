#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/engine/elements.hpp"
#include "sim/engine/rays.hpp"
#include "small_worlds.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// Walls 1 m ahead and 2 m to the left of a robot, whose own wheel stands in the way.
constexpr const char* room = R"(<mujoco><size njmax="400" nconmax="100"/><worldbody>
    <geom name="ahead" type="box" pos="1.5 0 0" size="0.5 3 1"/>
    <geom name="left" type="plane" pos="0 2 0" zaxis="0 -1 0" size="5 5 0.1" group="2"/>
    <geom name="glass" type="box" pos="0 -0.5 0" size="3 0.1 1" rgba="1 1 1 0"/>
    <body name="robot"><freejoint/><geom size="0.1" mass="1"/><site name="laser"/>
      <body pos="0.3 0 0"><joint name="wheel"/><geom size="0.1" mass="1"/></body></body>
  </worldbody><option gravity="0 0 0"/></mujoco>)";

TEST(Scan, MeasuresTheDistanceOnEachRay) {
  const auto world = open_text("room", room);
  const auto fan = receptor<std::array<float, 3>>(
      *world,
      {"a.s.r", "scan", {"laser"}, {{"from", -pi / 2}, {"to", WorldValue(pi / 2, "rad")}, {"reach", 4}}});
  const auto ranges = read_as<std::array<float, 3>>(*fan);
  EXPECT_EQ(ranges[0], 4) << "glass is invisible, and there is nothing behind it";
  EXPECT_FLOAT_EQ(ranges[1], 1) << "not the robot's own wheel";
  EXPECT_FLOAT_EQ(ranges[2], 2);
}

TEST(Scan, AFullCircleHasNoRayTwice) {
  const auto world = open_text("circle", room);
  const auto fan = receptor<std::array<double, 4>>(*world, {"a.s.r", "scan", {"laser"}, {{"reach", 9}}});
  const auto ranges = read_as<std::array<double, 4>>(*fan);  // behind, right, ahead, left
  EXPECT_EQ(ranges[0], 9);
  EXPECT_NEAR(ranges[2], 1, 1e-12);
  EXPECT_NEAR(ranges[3], 2, 1e-12);
}

TEST(Scan, LeavesOutGroupsAndHasNoise) {
  const auto world = open_text("groups", room);
  const auto fan = receptor<std::array<double, 1>>(
      *world, {"a.s.r", "scan", {"laser"}, {{"from", pi / 2}, {"to", pi / 2}, {"reach", 4}, {"groups", 2}}});
  EXPECT_EQ((read_as<std::array<double, 1>>(*fan)[0]), 4);
  const auto noisy = receptor<std::array<double, 1>>(
      *world, {"a.s.n", "scan", {"laser"}, {{"from", 0}, {"to", 0}, {"noise", 0.05}}});
  const double first = read_as<std::array<double, 1>>(*noisy)[0];
  EXPECT_NE(first, (read_as<std::array<double, 1>>(*noisy)[0]));
  EXPECT_NEAR(first, 1, 0.3);
}

/// Many geoms of all shapes about a slanted site.
std::string thicket() {
  std::string geoms;
  const char* const shapes[] = {"sphere", "capsule", "box", "cylinder", "ellipsoid"};
  for (int index = 0; index < 60; ++index) {
    const double angle = index * 0.7, away = 0.4 + index % 7 * 0.35;
    geoms += "<geom type='" + std::string(shapes[index % 5]) + "' size='0.08 0.2 0.12' pos='" +
             std::to_string(away * std::cos(angle)) + " " + std::to_string(away * std::sin(angle)) + " " +
             std::to_string(0.05 * (index % 3)) + "' euler='" + std::to_string(7 * index) + " 20 0'/>";
  }
  return "<mujoco><worldbody><geom type='plane' size='9 9 1' pos='0 0 -0.3'/><body name='b'><freejoint/>"
         "<geom size='0.01' mass='1'/><site name='eye' euler='10 5 0'/></body>" +
         geoms + "</worldbody></mujoco>";
}

TEST(Scan, FindsWhatTheEnginesOwnRaysFind) {
  auto loaded = sim::Physics::load(file_with("thicket.xml", thicket()));
  ASSERT_TRUE(loaded) << loaded.problem();
  const sim::Physics& physics = **loaded;
  const mjModel& model = physics.model();
  sim::Fan fan{.site = 0, .angles_rad = {}, .reach_m = 3, .geoms = sim::geoms_around(model, 0, {})};
  for (int ray = 0; ray < 720; ++ray) fan.angles_rad.push_back(ray * pi / 360);
  std::vector<double> distances(fan.angles_rad.size());
  sim::cast(physics, fan, distances);
  const mjData& now = physics.positions();
  const mjtNum* const axes = now.site_xmat;
  int hits = 0;
  for (std::size_t ray = 0; ray < distances.size(); ++ray) {
    const double c = std::cos(fan.angles_rad[ray]), s = std::sin(fan.angles_rad[ray]);
    const mjtNum direction[3] = {axes[0] * c + axes[1] * s, axes[3] * c + axes[4] * s,
                                 axes[6] * c + axes[7] * s};
    int geom = -1;
    const mjtNum own = mj_ray(&model, &now, now.site_xpos, direction, nullptr, 1, 1, &geom);
    EXPECT_EQ(distances[ray], own >= 0 && own < 3 ? own : 3) << ray;
    hits += own >= 0 && own < 3 ? 1 : 0;
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace tessera::testing
