// Times that a controller draws, held against the distributions of the specification (Kolmogorov and Smirnov).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "spec/model/time_points.hpp"
#include "spec_reading.hpp"
#include "subsystem/call_times.hpp"

namespace tessera::spec {
namespace {

using namespace std::chrono_literals;

constexpr int draws = 100'000;
/// The largest distance that one of a hundred samples of this size exceeds, by the limit of Kolmogorov's distribution.
const double largest_distance = 1.63 / std::sqrt(draws);

std::vector<double> drawn_ms(const TimePoints& points, std::uint64_t seed) {
  std::vector<tessera::TimePoint> table;
  for (const TimePoint& point : points) table.push_back({point.time, point.below});
  const tessera::Behaviour behaviour{"drive", points.front().time, points.back().time, table};
  CallTimes times(seed, "robot.control");
  std::vector<double> all;
  for (int call = 0; call < draws; ++call)
    all.push_back(std::chrono::duration<double, std::milli>(times.draw(behaviour)).count());
  std::ranges::sort(all);
  return all;
}

double distance(const std::vector<double>& sorted, const std::function<double(double)>& cumulative) {
  double greatest = 0;
  for (std::size_t index = 0; index < sorted.size(); ++index) {
    const double expected = cumulative(sorted[index]);
    greatest = std::max({greatest, expected - static_cast<double>(index) / draws,
                         static_cast<double>(index + 1) / draws - expected});
  }
  return greatest;
}

double normal(double deviations) { return std::erfc(-deviations / std::numbers::sqrt2) / 2; }

struct Normal {
  double mean, deviation, shortest, longest;
  [[nodiscard]] double operator()(double at) const {
    const auto below = [&](double time) { return normal((time - mean) / deviation); };
    return (below(at) - below(shortest)) / (below(longest) - below(shortest));
  }
};

TEST(DrawnTimes, HaveTheNormalDistributionThatIsCutOff) {
  const auto in_ns = [](double ms) { return std::chrono::nanoseconds(std::llround(ms * 1e6)); };
  for (const Normal& one : {Normal{2, 0.3, 1, 3}, Normal{2, 1, 1.5, 4}, Normal{1, 0.5, 1, 9},
                            Normal{5, 0.01, 0, 10}, Normal{2, 50, 1, 3}})
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const std::vector<double> all = drawn_ms(
          normal_points(in_ns(one.mean), in_ns(one.deviation), in_ns(one.shortest), in_ns(one.longest)),
          seed);
      EXPECT_GE(all.front(), one.shortest);
      EXPECT_LE(all.back(), one.longest);
      EXPECT_LT(distance(all, one), largest_distance)
          << one.mean << " " << one.deviation << ", seed " << seed;
      // The test tells it from another one.
      EXPECT_GT(distance(all, Normal{one.mean + 0.05 * std::min(one.deviation, one.longest - one.shortest),
                                     one.deviation, one.shortest, one.longest}),
                one.deviation > 10 ? 0 : largest_distance);
    }
}

TEST(DrawnTimes, HaveTheDistributionThatWasMeasured) {
  std::vector<std::chrono::nanoseconds>
      measured;  // quantiles of 1 ms and an exponential distribution of 0.5 ms
  constexpr int calls = 5'000;
  const auto quantile = [](double share) { return 1 - 0.5 * std::log1p(-share); };
  for (int call = 0; call < calls; ++call)
    measured.emplace_back(std::llround(quantile((call + 0.5) / calls) * 1e6));
  std::swap(measured.front(), measured.back());
  const TimePoints points = measured_points(measured);
  EXPECT_EQ(points.front().time, *std::ranges::min_element(measured));
  EXPECT_EQ(points.back().time, *std::ranges::max_element(measured));
  for (const std::uint64_t seed : {1U, 2U, 3U})
    EXPECT_LT(distance(drawn_ms(points, seed), [](double at) { return 1 - std::exp((1 - at) / 0.5); }),
              largest_distance)
        << seed;
}

TEST(DrawnTimes, OfFewCallsLieBetweenThem) {
  EXPECT_EQ(measured_points({2ms}), (TimePoints{{2ms, 0}, {2ms, all_calls}}));
  const std::vector<double> all = drawn_ms(measured_points({3ms, 1ms}), 1);
  EXPECT_LT(distance(all, [](double at) { return (at - 1) / 2; }), largest_distance);
}

TEST(DrawnTimes, ArePartOfTheModel) {
  const Reading reading(golden("valid/drawn_times.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Behaviour& plan = reading.model->subsystem({0}).behaviours[0];
  EXPECT_EQ(plan.takes.shortest, 1s);
  EXPECT_EQ(plan.takes.longest, 3s);
  EXPECT_EQ(plan.takes.points.front(), (TimePoint{1s, 0}));
  EXPECT_EQ(plan.takes.points.back(), (TimePoint{3s, all_calls}));
  const Behaviour& drive = reading.model->subsystem({0}).behaviours[1];
  EXPECT_EQ(drive.uses,
            (std::vector<ResourceUse>{
                {"energy", "J", 80, {}}, {"bandwidth", "MB", 3, {}}, {"brushes", "", 2.0 / 3600, {}}}));
  const Behaviour& listen = reading.model->subsystem({1}).behaviours[0];
  ASSERT_TRUE(listen.takes.measured);
  EXPECT_EQ(listen.takes.measured->recording, "monday.tsr");
  EXPECT_EQ(listen.takes.longest, 8s);
  EXPECT_TRUE(listen.takes.points.empty());  // until the recording is read
}

}  // namespace
}  // namespace tessera::spec
