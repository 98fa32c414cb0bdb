// Models placed in the simulated world, expanded by fleet.

#include <array>
#include <cmath>
#include <numbers>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string with_models(const std::string& models) {
  return "tessera: 1\nsystem: demo\n"
         "templates: { cart: { control: { rate: 1 Hz, behaviours: { run: {} } } } }\n"
         "agents: { cart: { use: cart, count: 3 }, arm: { use: cart } }\n"
         "simulation: { world: hall.xml, models: { " +
         models + " } }\n";
}

using Point = std::array<double, 3>;

TEST(Placements, AGridIsFilledRowByRow) {
  const Reading reading(with_models(
      "\"cart[*]\": { model: cart.xml, grid: { at: [1, 2], columns: 2, spacing: 50 cm }, heading: 90 deg }"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& models = reading.model->simulation->models;
  ASSERT_EQ(models.size(), 3U);
  EXPECT_EQ(models[0].instance, "cart[0]");
  EXPECT_EQ(models[1].at_m, (Point{1.5, 2, 0}));
  EXPECT_EQ(models[2].at_m, (Point{1, 2.5, 0}));
  EXPECT_DOUBLE_EQ(models[2].heading_rad, std::numbers::pi / 2);
  EXPECT_TRUE(models[2].is_agent);
  EXPECT_EQ(models[2].model, "cart.xml");
}

TEST(Placements, OnACircleTheyLookToTheCentre) {
  const Reading reading(with_models(
      R"("cart[*]": { model: cart.xml, circle: { at: [1, 0], radius: 2 m, from: 180 deg }, heading: 90 deg })"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& models = reading.model->simulation->models;
  ASSERT_EQ(models.size(), 3U);
  EXPECT_NEAR(models[0].at_m->at(0), -1, 1e-12);
  EXPECT_NEAR(models[0].heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(models[1].at_m->at(0), 2, 1e-12);
  EXPECT_NEAR(models[1].at_m->at(1), -std::sqrt(3), 1e-12);
  EXPECT_NEAR(models[1].heading_rad, std::numbers::pi * 7 / 6, 1e-12);
}

TEST(Placements, AListHasOnePlaceForEach) {
  const Reading reading(with_models(
      "\"cart[*]\": { model: cart.xml, at: [[0, 0], [1, 0, 0.1], [2, 0]], heading: [0, 1 rad, 2 rad] }, "
      "arm: { model: arm.xml, at: [0.4, 0.25, 0], pose: home }"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& models = reading.model->simulation->models;
  ASSERT_EQ(models.size(), 4U);
  EXPECT_EQ(models[1].at_m, (Point{1, 0, 0.1}));
  EXPECT_EQ(models[2].heading_rad, 2);
  EXPECT_EQ(models[3].instance, "arm");
  EXPECT_EQ(models[3].pose, "home");
}

TEST(Placements, ThingsAreNoAgents) {
  const Reading reading(
      with_models("\"box[*]\": { model: box.xml, count: 2, scatter: store, apart: 10 cm, vary: { box.mass: "
                  "[0.04, 0.06] } }, "
                  "table: { model: table.xml }, \"cart[1]\": { model: cart.xml }"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& models = reading.model->simulation->models;
  ASSERT_EQ(models.size(), 4U);
  EXPECT_EQ(models[1].instance, "box[1]");
  EXPECT_FALSE(models[1].is_agent);
  EXPECT_EQ(models[1].scatter, "store");
  EXPECT_EQ(models[1].apart_m, 0.1);
  EXPECT_EQ(models[1].vary.at("box.mass"), std::pair(0.04, 0.06));
  EXPECT_EQ(models[1].at_m, std::nullopt);
  EXPECT_EQ(models[2].instance, "table");
  EXPECT_EQ(models[3].instance, "cart[1]");
}

}  // namespace
}  // namespace tessera::spec
