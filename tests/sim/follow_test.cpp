// The paper's table keeps the robot on the line: with physics, at the rates of the example, with the shortest
// and the longest delays that the pipeline sensor -> control -> motor may have.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "../environment.hpp"
#include "drawing.hpp"
#include "follower.hpp"
#include "sim/track.hpp"
#include "world_library.hpp"

using tessera::share_of;
using tessera::WorldOptions;
using tessera::sim::LineMetrics;
using tessera::sim::Point;
using tessera::sim::Skeleton;
using tessera::sim::Track;

namespace {

constexpr Follower fast{.sensor_delay_ms = 0, .motor_delay_ms = 0};
constexpr Follower usual{.sensor_delay_ms = 10, .motor_delay_ms = 10};
constexpr Follower slow{.sensor_delay_ms = 20, .motor_delay_ms = 70};
constexpr std::array all{fast, usual, slow};

struct Start {
  std::string track;
  double x_m, y_m, heading_rad;
};

WorldOptions world_at(const Start& start, std::uint64_t seed) {
  return {
      .world = line_world(),
      .track = start.track,
      .start_x_m = start.x_m,
      .start_y_m = start.y_m,
      .start_heading_rad = start.heading_rad,
      .seed = seed,
  };
}

LineMetrics follow(const Follower& follower, const Start& start, std::uint64_t seed, double for_s) {
  const auto track = Track::load(start.track, 0.005);
  if (!track) throw std::runtime_error(track.problem());
  return measure(skeleton(*track), drive(follower, world_at(start, seed), for_s));
}

TEST(Follow, KeepsToEveryShippedTrackBothWaysRound) {
  const std::string oval = shipped_track("oval.png");
  const std::string curves = shipped_track("curves.png");
  struct Case {
    Start start;
    double laps;  ///< in 120 s
  };
  const std::array cases{Case{{oval, 1.2, 0.1, 0}, 4}, Case{{oval, 1.2, 0.1, M_PI}, 4},
                         Case{{oval, 0.4, 0.2, M_PI / 2}, 4}, Case{{curves, 1.2, 0.2, 0}, 3},
                         Case{{curves, 1.2, 0.2, M_PI}, 3}};
  for (const Case& c : share_of(cases)) {
    std::uint64_t seed = 1;
    for (const Follower& follower : share_of(all)) {
      const LineMetrics metrics = follow(follower, c.start, ++seed, 120);
      SCOPED_TRACE(c.start.track + " " + std::to_string(follower.motor_delay_ms) + " ms, seed " +
                   std::to_string(seed));
      EXPECT_GT(metrics.laps, c.laps);
      EXPECT_LT(metrics.longest_loss_s, 0.5);
      EXPECT_LT(metrics.max_error_m, 0.06);
    }
  }
}

TEST(Follow, KeepsToAnyLineAsWideWithCurvesNoTighter) {
  for (std::uint64_t seed = 1; seed <= share_of(5); ++seed) {
    const Drawing loop = random_loop(seed, 0.2);
    const std::string png = write_png(loop, "loop" + std::to_string(seed));
    const auto& points = loop.strokes[0].points;
    const double heading = std::atan2(points[1].y_m - points[0].y_m, points[1].x_m - points[0].x_m);
    for (const double direction : {0.0, M_PI}) {
      for (const Follower& follower : {fast, slow}) {
        const LineMetrics metrics =
            follow(follower, {png, points[0].x_m, points[0].y_m, heading + direction}, seed, 60);
        SCOPED_TRACE("loop " + std::to_string(seed) + ", " + std::to_string(follower.motor_delay_ms) + " ms");
        EXPECT_LT(metrics.longest_loss_s, 0.5);
        EXPECT_GT(metrics.laps, 0.4);
      }
    }
    std::filesystem::remove(png);
  }
}

TEST(Follow, PassesCrossings) {
  std::vector<Point> eight;
  for (int i = 0; i < 600; ++i) {
    const double t = 2 * M_PI * i / 600;
    eight.push_back({1.2 + std::sin(t), 0.8 + 0.6 * std::sin(2 * t)});
  }
  const std::string png =
      write_png(Drawing{.width_m = 2.4, .height_m = 1.6, .strokes = {{eight, true}}}, "eight");
  for (std::uint64_t seed = 1; seed <= share_of(3); ++seed) {
    const LineMetrics metrics = follow(usual, {png, eight[75].x_m, eight[75].y_m, 0}, seed, 120);
    EXPECT_GT(metrics.laps, 2.5) << seed;
    EXPECT_LT(metrics.longest_loss_s, 0.5) << seed;
  }
  std::filesystem::remove(png);
}

TEST(Follow, TheTableAloneDoesNotCrossAGapOfTwoCentimetres) {
  for (const double x_m : {1.2, 1.203, 1.207}) {
    for (const Follower& follower : {fast, usual}) {
      const auto trace = drive(follower, world_at({shipped_track("gap.png"), x_m, 0.2, 0}, 1), 20);
      EXPECT_LT(trace.points.back().x_m, 1.4) << x_m;
    }
  }
}

TEST(Follow, SearchingStraightOnCrossesTheGaps) {
  for (const Follower& follower : share_of(all)) {
    for (const double heading : {0.0, M_PI}) {
      Follower searching = follower;
      searching.search = true;
      const LineMetrics metrics = follow(searching, {shipped_track("gap.png"), 1.2, 0.2, heading}, 1, 120);
      EXPECT_GT(metrics.laps, 4);
      EXPECT_LT(metrics.longest_loss_s, 0.5);
    }
  }
}

}  // namespace
