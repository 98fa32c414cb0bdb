#include "sim/compose/layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "files.hpp"

namespace tessera::testing {
namespace {

using ::testing::HasSubstr;

std::vector<sim::Placement> boxes(int count) {
  std::vector<sim::Placement> all;
  for (int i = 0; i < count; ++i) all.push_back(placed("box[" + std::to_string(i) + "]", model("box.xml")));
  return all;
}

TEST(Layout, GridFillsRowAfterRow) {
  const auto placed = sim::on_grid({1, 2, 0.5, 3, 0.8}, boxes(5));
  ASSERT_TRUE(placed) << placed.problem();
  EXPECT_DOUBLE_EQ((*placed)[0].x_m, 1);
  EXPECT_DOUBLE_EQ((*placed)[2].x_m, 2.6);
  EXPECT_DOUBLE_EQ((*placed)[2].y_m, 2);
  EXPECT_DOUBLE_EQ((*placed)[4].x_m, 1.8);
  EXPECT_DOUBLE_EQ((*placed)[4].y_m, 2.8);
  EXPECT_DOUBLE_EQ((*placed)[4].z_m, 0.5);
  EXPECT_THAT(sim::on_grid({0, 0, 0, 0, 1}, boxes(1)).problem(), HasSubstr("column"));
  EXPECT_THAT(sim::on_grid({0, 0, 0, 1, 0}, boxes(1)).problem(), HasSubstr("spacing"));
  EXPECT_THAT(sim::on_grid({std::nan(""), 0, 0, 1, 1}, boxes(1)).problem(), HasSubstr("finite"));
}

double distance(const sim::Placement& a, const sim::Placement& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m);
}

TEST(Layout, ScatteredThingsAreApartAndInTheirSite) {
  struct Case {
    const char* site;
    double apart_m;
    double (*excess)(double x, double y, double z);  ///< at most 0 inside
  };
  for (const Case& c :
       {Case{"store", 0.5,
             [](double x, double y, double z) {
               const double angle = std::acos(-1.0) / 6;
               const double u = std::cos(angle) * (x - 3) + std::sin(angle) * (y + 4);
               const double v = -std::sin(angle) * (x - 3) + std::cos(angle) * (y + 4);
               return std::max({std::abs(u) - 2, std::abs(v) - 1, std::abs(z - 0.5) - 0.5});
             }},
        Case{"disc", 0.4,
             [](double x, double y, double z) {
               return std::max(std::hypot(x + 3, y) - 1.5, std::abs(z - 1) - 0.2);
             }},
        Case{"ball", 0.3, [](double x, double y, double z) { return std::hypot(x, y, z - 4) - 1; }},
        Case{"egg", 0.1,
             [](double x, double y, double z) { return std::hypot(x, (y - 3) / 0.5, (z - 1) / 0.25) - 1; }},
        Case{"pill", 0.1, [](double x, double y, double z) {
               const double beyond = std::max(0.0, std::abs(y) - 1);
               return std::hypot(x - 4, beyond, z - 1) - 0.3;
             }}}) {
    SCOPED_TRACE(c.site);
    const auto things = sim::scatter(model("world.xml"), c.site, c.apart_m, 7, boxes(15));
    ASSERT_TRUE(things) << things.problem();
    double largest = -1;
    for (std::size_t i = 0; i < things->size(); ++i) {
      const sim::Placement& thing = (*things)[i];
      largest = std::max(largest, c.excess(thing.x_m, thing.y_m, thing.z_m));
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance(thing, (*things)[j]), c.apart_m);
    }
    EXPECT_LE(largest, 1e-12);
    EXPECT_GT(largest, -0.3);  // not all in the middle
  }
}

TEST(Layout, SeedDecidesAndOffsetsAreAdded) {
  std::vector<sim::Placement> things = boxes(3);
  const auto one = sim::scatter(model("world.xml"), "ball", 0.2, 1, things);
  const auto again = sim::scatter(model("world.xml"), "ball", 0.2, 1, things);
  const auto other = sim::scatter(model("world.xml"), "ball", 0.2, 2, things);
  for (sim::Placement& thing : things) thing.z_m = 5;
  const auto lifted = sim::scatter(model("world.xml"), "ball", 0.2, 1, things);
  ASSERT_TRUE(one && again && other && lifted);
  EXPECT_EQ((*one)[2].x_m, (*again)[2].x_m);
  EXPECT_NE((*one)[2].x_m, (*other)[2].x_m);
  EXPECT_EQ((*one)[2].z_m + 5, (*lifted)[2].z_m);
}

TEST(Layout, SaysWhyNothingIsScattered) {
  const std::string world = model("world.xml");
  EXPECT_THAT(sim::scatter(world, "ball", 1.5, 1, boxes(9)).problem(),
              ::testing::StartsWith(world + ": there is no room in site 'ball' for 9 things 1.5 m apart; "));
  EXPECT_EQ(sim::scatter(world, "stor", 1, 1, boxes(1)).problem(),
            world + ": has no site 'stor'; it has store, disc, ball, egg, pill; did you mean 'store'?");
  EXPECT_THAT(sim::scatter(world, "store", std::nan(""), 1, boxes(1)).problem(), HasSubstr("distance"));
  EXPECT_THAT(sim::scatter(world, "store", -1, 1, boxes(1)).problem(), HasSubstr("distance"));
  EXPECT_THAT(sim::scatter("/nowhere.xml", "store", 1, 1, boxes(1)).problem(), HasSubstr("no such file"));
}

}  // namespace
}  // namespace tessera::testing
