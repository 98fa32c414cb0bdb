#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "files.hpp"
#include "sim/compose/layout.hpp"

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Composition, PutsTheModelWhereItsPlacementSays) {
  sim::Placement rover = placed("rover", model("rover.xml"), 2, 3);
  rover.heading_rad = std::acos(-1.0) / 2;
  sim::Placement planar = placed("planar", model("planar.xml"), -1, 4);
  planar.heading_rad = rover.heading_rad;
  const sim::ComposedWorld world = loaded({rover, planar});
  const mjModel& m = *world.model;
  mjData* data = mj_makeData(&m);
  mj_kinematics(&m, data);
  const auto expect_at = [&](const char* body, double x, double y, double z, double heading) {
    const int id = mj_name2id(&m, mjOBJ_BODY, body);
    ASSERT_GE(id, 0) << body;
    EXPECT_NEAR(data->xpos[3 * id], x, 1e-12) << body;
    EXPECT_NEAR(data->xpos[3 * id + 1], y, 1e-12) << body;
    EXPECT_NEAR(data->xpos[3 * id + 2], z, 1e-12) << body;
    EXPECT_NEAR(std::atan2(data->xmat[9 * id + 3], data->xmat[9 * id]), heading, 1e-12) << body;
  };
  expect_at("rover/base", 2, 3, 0.05, rover.heading_rad);
  expect_at("rover/left", 2 - 0.14, 3, 0.05, rover.heading_rad);
  expect_at("planar/base", -1, 4, 0.05, planar.heading_rad + 0.3);
  mj_deleteData(data);
}

TEST(Composition, KeepsTheNamesOfTheWorldAndOfUnnamedElements) {
  const sim::ComposedWorld world = loaded({placed("rover", model("rover.xml"))});
  const mjModel& m = *world.model;
  EXPECT_GE(mj_name2id(&m, mjOBJ_GEOM, "floor"), 0);
  EXPECT_GE(mj_name2id(&m, mjOBJ_BODY, "door"), 0);
  EXPECT_GE(mj_name2id(&m, mjOBJ_SENSOR, "rover/gyro"), 0);
  const int base = mj_name2id(&m, mjOBJ_BODY, "rover/base");
  EXPECT_STREQ(mj_id2name(&m, mjOBJ_GEOM, m.body_geomadr[base]), "rover/hull");
  EXPECT_EQ(mj_id2name(&m, mjOBJ_GEOM, m.body_geomadr[base] + 1), nullptr);
  EXPECT_EQ(m.opt.timestep, 0.005);
}

TEST(Composition, WorldAloneIsTheWorld) {
  const sim::ComposedWorld world = loaded({});
  const auto alone = sim::load_model(model("world.xml"));
  ASSERT_TRUE(alone);
  EXPECT_EQ(world.model->nbody, (*alone)->nbody);
  EXPECT_EQ(world.model->ngeom, (*alone)->ngeom);
  EXPECT_EQ(world.model->stat.extent, (*alone)->stat.extent);
}

TEST(Composition, ModelsOfOneNameInTwoFoldersStayApart) {
  const std::string small =
      file_with("small/ball.xml",
                "<mujoco><default><geom size='0.1'/></default><asset><material name='m' "
                "rgba='1 0 0 1'/></asset><worldbody><body name='b'><freejoint/><geom "
                "name='g' material='m'/></body></worldbody></mujoco>");
  const std::string large =
      file_with("large/ball.xml",
                "<mujoco><default><geom size='0.3'/></default><asset><material name='m' "
                "rgba='0 1 0 1'/></asset><worldbody><body name='b'><freejoint/><geom "
                "name='g' material='m'/></body></worldbody></mujoco>");
  const sim::ComposedWorld world = loaded({placed("a", small), placed("b", large), placed("c", small)});
  const auto size = [&](const char* geom) {
    return world.model->geom_size[3 * mj_name2id(world.model.get(), mjOBJ_GEOM, geom)];
  };
  EXPECT_EQ(size("a/g"), 0.1);
  EXPECT_EQ(size("b/g"), 0.3);
  EXPECT_EQ(size("c/g"), 0.1);
  EXPECT_EQ(world.model->nmat, 2);
}

TEST(Composition, WhatIsWeldedToTheWorldMovesWithItsPlacement) {
  sim::Placement arm = placed("arm", model("arm.xml"), 1, 2);
  const sim::ComposedWorld world = loaded({arm});
  const mjModel& m = *world.model;
  for (const char* name : {"arm/held", "arm/fixed"}) {
    const int id = mj_name2id(&m, mjOBJ_EQUALITY, name);
    ASSERT_GE(id, 0);
    EXPECT_STREQ(mj_id2name(&m, mjOBJ_BODY, m.eq_obj2id[id]), "arm");
  }
  // Neither the floor of the world nor the fixed part of the file collides with the excluded body.
  EXPECT_EQ(m.nexclude, 2);
}

TEST(Composition, StatelessActuatorsComeFirst) {
  const sim::ComposedWorld world =
      loaded({placed("a", model("states.xml")), placed("b", model("rover.xml"), 3)});
  const mjModel& m = *world.model;
  bool state = false;
  for (int u = 0; u < m.nu; ++u) {
    const bool has_state = m.actuator_dyntype[u] != mjDYN_NONE;
    EXPECT_FALSE(state && !has_state);
    state = has_state;
  }
  EXPECT_TRUE(state);
}

TEST(Composition, WarnsOfOptionsThatTheWorldDoesNotGive) {
  const sim::ComposedWorld world = loaded({placed("a", model("rover.xml")), placed("b", model("rover.xml"))});
  EXPECT_THAT(world.warnings, ElementsAre(model("rover.xml") +
                                          ": wants the option timestep=\"0.002\"; the world has \"0.005\""));
  EXPECT_THAT(loaded({placed("a", model("box.xml"))}).warnings, IsEmpty());
}

TEST(Composition, TheSameInputGivesTheSameText) {
  const std::vector<sim::Placement> placements{placed("a", model("arm.xml")),
                                               placed("b", model("rover.xml"))};
  const auto one = sim::compose(model("world.xml"), placements);
  const auto other = sim::compose(model("world.xml"), placements);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->mjcf, other->mjcf);
}

TEST(Composition, FiftyRoversAreOneWorld) {
  std::vector<sim::Placement> rovers;
  for (int i = 0; i < 50; ++i)
    rovers.push_back(placed("robot[" + std::to_string(i) + "]", model("rover.xml")));
  const auto on_grid = sim::on_grid({-4, -4, 0, 8, 0.6}, rovers);
  ASSERT_TRUE(on_grid) << on_grid.problem();
  const sim::ComposedWorld world = loaded(*on_grid);
  const int actuators = 100, bodies_of_rover = 3;
  EXPECT_EQ(world.model->nu, actuators);
  EXPECT_EQ(world.model->nbody, 2 + 50 * bodies_of_rover);
}

}  // namespace
}  // namespace tessera::testing
