#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "drawing.hpp"
#include "sim/track.hpp"
#include "world_library.hpp"

using tessera::sim::Point;
using tessera::sim::Skeleton;
using tessera::sim::Track;

namespace {

Skeleton of(const std::vector<std::uint8_t>& grey, std::size_t width_px, double metres_per_pixel) {
  static int count = 0;
  const std::string png = write_png(grey, width_px, "skeleton" + std::to_string(count++));
  const auto track = Track::load(png, metres_per_pixel);
  std::filesystem::remove(png);
  if (!track) throw std::runtime_error(track.problem());
  return skeleton(*track);
}

Skeleton of(const Drawing& d) {
  return of(rasterise(d), static_cast<std::size_t>(std::lround(d.width_m / d.metres_per_pixel)),
            d.metres_per_pixel);
}

double farthest_from_circle(const Skeleton& line, Point centre, double radius) {
  double most = 0;
  for (const Point& p : line.points)
    most = std::max(most, std::abs(std::hypot(p.x_m - centre.x_m, p.y_m - centre.y_m) - radius));
  return most;
}

std::vector<Point> arc(Point centre, double radius, double from, double to) {
  std::vector<Point> points;
  for (int i = 0; i <= 100; ++i) {
    const double angle = from + (to - from) * i / 100;
    points.push_back({centre.x_m + radius * std::cos(angle), centre.y_m + radius * std::sin(angle)});
  }
  return points;
}

class SkeletonAtScale : public testing::TestWithParam<double> {};

TEST_P(SkeletonAtScale, LiesInTheMiddleOfTheLine) {
  const Drawing ring{.width_m = 1.2,
                     .height_m = 1.2,
                     .metres_per_pixel = GetParam(),
                     .strokes = {{circle(0.6, 0.6, 0.4), true}}};
  const Skeleton line = of(ring);
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.4, 0.02);
  EXPECT_LT(farthest_from_circle(line, {0.6, 0.6}, 0.4), 0.006);
}
INSTANTIATE_TEST_SUITE_P(Scales, SkeletonAtScale, testing::Values(0.001, 0.002, 0.0033, 0.005, 0.01));

TEST(Skeleton, OfTheShippedTracksHasTheirLength) {
  struct Case {
    const char* name;
    double length_m;
  };
  for (const Case& c : {Case{"oval.png", 2.8 + 0.6 * M_PI}, Case{"curves.png", 2.4 + 1.2 * M_PI},
                        Case{"gap.png", 1.6 + 0.8 * M_PI}}) {
    const Skeleton line = skeleton(*Track::load(shipped_track(c.name), 0.005));
    EXPECT_TRUE(line.closed) << c.name;
    EXPECT_NEAR(line.length_m(), c.length_m, 0.02) << c.name;
  }
}

TEST(Skeleton, OfAnEmptyPictureIsEmpty) {
  EXPECT_TRUE(of(std::vector<std::uint8_t>(200 * 100, 255), 200, 0.005).points.empty());
  EXPECT_TRUE(of({255}, 1, 0.005).points.empty());
  EXPECT_TRUE(of({0}, 1, 0.005).points.empty());
}

TEST(Skeleton, APictureSmallerThanASpeckIsEmpty) {
  EXPECT_TRUE(of({255, 0, 255, 0, 0, 0, 255, 0, 255}, 3, 0.005).points.empty());
}

TEST(Skeleton, OfABlackPictureDoesNotFail) {
  EXPECT_FALSE(of(std::vector<std::uint8_t>(200 * 100, 0), 200, 0.005).closed);
}

TEST(Skeleton, OfSpecksAloneIsEmpty) {
  std::vector<std::uint8_t> grey(200 * 200, 255);
  for (std::size_t i = 0; i < grey.size(); i += 397) grey[i] = 0;
  EXPECT_TRUE(of(grey, 200, 0.005).points.empty());
}

TEST(Skeleton, OfAnOpenLineIsOpen) {
  const Drawing wave{
      .width_m = 2, .height_m = 1, .strokes = {{{{0.2, 0.5}, {0.8, 0.6}, {1.2, 0.4}, {1.8, 0.5}}, false}}};
  const Skeleton line = of(wave);
  EXPECT_FALSE(line.closed);
  EXPECT_NEAR(line.length_m(), std::hypot(0.6, 0.1) * 2 + std::hypot(0.4, 0.2), 0.08);
}

TEST(Skeleton, BridgesGapsOfSixCentimetres) {
  for (const double gap : {0.02, 0.04, 0.06}) {
    const double angle = (gap + 0.05) / 0.4;  // strokes have round ends, half the line's width long
    Drawing ring{.width_m = 1.2,
                 .height_m = 1.2,
                 .strokes = {{arc({0.6, 0.6}, 0.4, angle, 3), false},
                             {arc({0.6, 0.6}, 0.4, 3 + angle, 2 * M_PI), false}}};
    const Skeleton line = of(ring);
    EXPECT_TRUE(line.closed) << gap;
    EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.4, 0.03) << gap;
  }
}

TEST(Skeleton, DoesNotBridgeATwentyCentimetreGap) {
  const Drawing ring{
      .width_m = 1.2, .height_m = 1.2, .strokes = {{arc({0.6, 0.6}, 0.4, 0.6, 2 * M_PI), false}}};
  EXPECT_FALSE(of(ring).closed);
}

TEST(Skeleton, TakesCrossingsStraightOn) {
  std::vector<Point> eight;
  double length = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = 2 * M_PI * i / 600;
    eight.push_back({1 + 0.8 * std::sin(t), 0.6 + 0.45 * std::sin(2 * t)});
    if (i > 0) length += std::hypot(eight[i].x_m - eight[i - 1].x_m, eight[i].y_m - eight[i - 1].y_m);
  }
  const Skeleton line = of(Drawing{.width_m = 2, .height_m = 1.2, .strokes = {{eight, true}}});
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), length, 0.05);
}

TEST(Skeleton, PrunesSpursAndLeavesBranches) {
  Drawing ring{.width_m = 1.6, .height_m = 1.2, .strokes = {{circle(0.6, 0.6, 0.4), true}}};
  ring.strokes.push_back({{{1.0, 0.6}, {1.04, 0.6}}, false});  // a bump
  ring.strokes.push_back({{{0.6, 1.0}, {1.5, 1.05}}, false});  // a long branch, tangential to the ring
  const Skeleton line = of(ring);
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.4, 0.04);
  EXPECT_LT(farthest_from_circle(line, {0.6, 0.6}, 0.4), 0.02);
}

TEST(Skeleton, OfALoopWithAShortcutIsTheLongestLoop) {
  Drawing d{.width_m = 1.6,
            .height_m = 1.2,
            .strokes = {{circle(0.8, 0.6, 0.4), true}, {{{0.4, 0.6}, {1.2, 0.6}}, false}}};
  const Skeleton line = of(d);
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.4, 0.06);
}

TEST(Skeleton, WithstandsNoise) {
  const Drawing ring{.width_m = 1.2, .height_m = 1.2, .strokes = {{circle(0.6, 0.6, 0.4), true}}};
  auto grey = rasterise(ring);
  std::mt19937 random(3);
  for (int i = 0; i < 600; ++i) grey[random() % grey.size()] ^= 0xff;  // 1 % of all pixels
  const Skeleton line = of(grey, 240, 0.005);
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.4, 0.08);
  EXPECT_LT(farthest_from_circle(line, {0.6, 0.6}, 0.4), 0.015);
}

TEST(Skeleton, FollowsAHandDrawnLine) {
  // A shaky hand: the middle wanders by 4 mm, and the pen's width changes between 3 and 6 cm.
  Drawing d{.width_m = 1.6, .height_m = 1.6, .strokes = {}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shake(-0.004, 0.004);
  auto points = circle(0.8, 0.8, 0.55);
  for (Point& p : points) p = {p.x_m + shake(random), p.y_m + shake(random)};
  auto grey =
      rasterise(Drawing{.width_m = 1.6, .height_m = 1.6, .line_width_m = 0.03, .strokes = {{points, true}}});
  for (std::size_t i = 0; i + 10 < points.size(); i += 25) {
    Drawing thick{
        .width_m = 1.6,
        .height_m = 1.6,
        .line_width_m = 0.06,
        .strokes = {
            {{points.begin() + static_cast<int>(i), points.begin() + static_cast<int>(i) + 10}, false}}};
    const auto more = rasterise(thick);
    for (std::size_t k = 0; k < grey.size(); ++k) grey[k] = std::min(grey[k], more[k]);
  }
  const Skeleton line = of(grey, 320, 0.005);
  EXPECT_TRUE(line.closed);
  EXPECT_NEAR(line.length_m(), 2 * M_PI * 0.55, 0.15);
  EXPECT_LT(farthest_from_circle(line, {0.8, 0.8}, 0.55), 0.015);
}

TEST(Skeleton, OfARandomLoopKeepsItsLength) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Drawing d = random_loop(seed, 0.2);
    const auto& points = d.strokes[0].points;
    double length = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point& next = points[(i + 1) % points.size()];
      length += std::hypot(next.x_m - points[i].x_m, next.y_m - points[i].y_m);
    }
    const Skeleton line = of(d);
    EXPECT_TRUE(line.closed) << seed;
    EXPECT_NEAR(line.length_m(), length, 0.01 * length) << seed;
  }
}

TEST(StartOn, IsTheStraightestStretchLookingAlongIt) {
  // Half a circle, then straight on to the right.
  const auto points = arc({0.5, 0.5}, 0.3, M_PI / 2, 3 * M_PI / 2);
  Skeleton line{points, false};
  for (int i = 1; i <= 100; ++i) line.points.push_back({0.5 + 0.01 * i, 0.2});
  const auto start = start_on(line);
  ASSERT_TRUE(start);
  EXPECT_GE(start->at.x_m, 0.49);
  EXPECT_NEAR(start->at.y_m, 0.2, 0.001);
  EXPECT_NEAR(start->heading_rad, 0, 0.01);
}

TEST(StartOn, NeedsALineLongerThanARobot) {
  EXPECT_FALSE(start_on(Skeleton{}));
  EXPECT_FALSE(start_on(Skeleton{{{0, 0}, {0.1, 0}}, false}));
}

}  // namespace
