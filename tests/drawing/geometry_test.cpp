#include "drawing/geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera::drawing {
namespace {

Curve straight(Point from, Point to) { return extended({from}, to); }

TEST(Curve, IsCutWhereItEntersAShape) {
  const auto in_circle = [](Point at) { return std::hypot(at.x - 100, at.y) <= 10; };
  const Curve cut = cut_at_end(straight({0, 0}, {100, 0}), in_circle);
  ASSERT_EQ(cut.size(), 4U);
  EXPECT_DOUBLE_EQ(cut.front().x, 0);
  EXPECT_NEAR(cut.back().x, 90, 1e-3);
}

TEST(Curve, LosesSegmentsThatLieInTheShape) {
  const auto beyond = [](Point at) { return at.x > 50; };
  const Curve cut = cut_at_end(extended(straight({0, 0}, {60, 0}), {100, 0}), beyond);
  ASSERT_EQ(cut.size(), 4U);
  EXPECT_NEAR(cut.back().x, 50, 1e-3);
}

TEST(Curve, StaysIfItLiesInTheShapeAsAWhole) {
  const Curve curve = straight({0, 0}, {1, 0});
  EXPECT_EQ(cut_at_end(curve, [](Point) { return true; }).size(), curve.size());
}

TEST(Curve, RunsBackwardsWhenReversed) {
  const Curve curve = reversed(straight({0, 0}, {3, 6}));
  EXPECT_DOUBLE_EQ(curve.front().y, 6);
  EXPECT_DOUBLE_EQ(curve.back().y, 0);
}

}  // namespace
}  // namespace tessera::drawing
