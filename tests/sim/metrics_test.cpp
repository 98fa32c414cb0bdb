#include <gtest/gtest.h>

#include <cmath>

#include "drawing.hpp"
#include "sim/track.hpp"

using tessera::sim::LineMetrics;
using tessera::sim::Point;
using tessera::sim::Skeleton;
using tessera::sim::Trace;
using tessera::sim::TracePoint;

namespace {

constexpr double radius = 0.5;
const Skeleton ring{circle(1, 1, radius), true};

/// Once around per 2 pi of angle, at that distance from the centre.
Trace around(double from, double to, double r, int count = 1000) {
  Trace trace;
  for (int i = 0; i <= count; ++i) {
    const double angle = from + (to - from) * i / count;
    trace.points.push_back({.t_s = i * 0.01,
                            .eye_x_m = 1 + r * std::cos(angle),
                            .eye_y_m = 1 + r * std::sin(angle),
                            .on_line = true});
  }
  return trace;
}

TEST(Metrics, LapsCountEitherDirection) {
  EXPECT_NEAR(measure(ring, around(0.3, 0.3 + 4 * M_PI, radius)).laps, 2, 0.001);
  EXPECT_NEAR(measure(ring, around(0.3, 0.3 - 3 * M_PI, radius)).laps, 1.5, 0.001);
}

TEST(Metrics, GoingBackUndoesProgress) {
  Trace trace = around(0, M_PI, radius);
  const Trace back = around(M_PI, 0, radius);
  trace.points.insert(trace.points.end(), back.points.begin(), back.points.end());
  EXPECT_NEAR(measure(ring, trace).laps, 0, 0.001);
}

TEST(Metrics, ErrorIsPositiveLeftOfTheDrivingDirection) {
  const LineMetrics counterclockwise = measure(ring, around(0, 2 * M_PI, radius - 0.02));
  const LineMetrics clockwise = measure(ring, around(2 * M_PI, 0, radius - 0.02));
  EXPECT_NEAR(counterclockwise.error_m[100], 0.02, 0.001);
  EXPECT_NEAR(clockwise.error_m[100], -0.02, 0.001);
  EXPECT_NEAR(clockwise.mean_error_m, 0.02, 0.001);
  EXPECT_NEAR(clockwise.max_error_m, 0.02, 0.001);
}

TEST(Metrics, ACrossedLoopCountsBranchByBranch) {
  Skeleton eight{{}, true};
  Trace trace;
  for (int i = 0; i < 600; ++i) {
    const double t = 2 * M_PI * i / 600;
    eight.points.push_back({std::sin(t), 0.5 * std::sin(2 * t)});
  }
  for (int i = 0; i <= 1800; ++i) {
    const double t = 2 * M_PI * i / 900;
    trace.points.push_back(
        {.t_s = i * 0.01, .eye_x_m = std::sin(t), .eye_y_m = 0.5 * std::sin(2 * t), .on_line = true});
  }
  EXPECT_NEAR(measure(eight, trace).laps, 2, 0.002);
}

TEST(Metrics, ALeapAcrossIsNoProgress) {
  Trace trace = around(0, 1, radius);
  const Trace there = around(3, 4, radius);
  trace.points.insert(trace.points.end(), there.points.begin(), there.points.end());
  EXPECT_NEAR(measure(ring, trace).laps, 2 / (2 * M_PI), 0.01);
}

TEST(Metrics, LossesAreTimed) {
  Trace trace = around(0, 1, radius);
  for (std::size_t i = 100; i < 150; ++i) trace.points[i].on_line = false;
  for (std::size_t i = 300; i < 320; ++i) trace.points[i].on_line = false;
  const LineMetrics metrics = measure(ring, trace);
  EXPECT_NEAR(metrics.line_lost_s, 0.7, 1e-9);
  EXPECT_NEAR(metrics.longest_loss_s, 0.5, 1e-9);
}

TEST(Metrics, AnOpenLineHasFractionsOfALap) {
  const Skeleton straight{{{0, 0}, {1, 0}, {2, 0}}, false};
  Trace trace;
  for (int i = 0; i <= 100; ++i)
    trace.points.push_back({.t_s = i * 0.01, .eye_x_m = 0.5 + i * 0.01, .eye_y_m = 0.03});
  const LineMetrics metrics = measure(straight, trace);
  EXPECT_NEAR(metrics.laps, 0.5, 1e-9);
  EXPECT_NEAR(metrics.mean_error_m, 0.03, 1e-9);
}

TEST(Metrics, WithoutALineOrAPathThereIsNothingButLosses) {
  Trace trace;
  trace.points = {{.t_s = 0}, {.t_s = 1}};
  const LineMetrics no_line = measure({}, trace);
  EXPECT_EQ(no_line.laps, 0);
  EXPECT_EQ(no_line.line_lost_s, 1);
  EXPECT_TRUE(no_line.error_m.empty());
  EXPECT_EQ(measure(ring, {}).laps, 0);
}

}  // namespace
