#include "statistics/clopper_pearson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace tessera::statistics {
namespace {

/// The probability that an event of probability `share` happens in `from` to `to` of `runs` runs: the
/// definition, summed up term by term.
double binomial(std::uint64_t from, std::uint64_t to, std::uint64_t runs, double share) {
  double sum = 0;
  const auto n = static_cast<double>(runs);
  for (std::uint64_t events = from; events <= to; ++events) {
    const auto k = static_cast<double>(events);
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(share) +
                    (n - k) * std::log1p(-share));
  }
  return sum;
}

TEST(IncompleteBeta, HasTheValuesOfItsClosedForms) {
  for (const double x : {0.0, 1e-9, 0.1, 0.5, 0.9, 0.999, 1.0}) {
    EXPECT_NEAR(incomplete_beta(x, 1, 1), x, 1e-14);
    EXPECT_NEAR(incomplete_beta(x, 3, 1), x * x * x, 1e-14);
    EXPECT_NEAR(incomplete_beta(x, 1, 5), 1 - std::pow(1 - x, 5), 1e-14);
    EXPECT_NEAR(incomplete_beta(x, 0.5, 0.5), 2 / std::acos(-1.0) * std::asin(std::sqrt(x)), 1e-13);
    EXPECT_NEAR(incomplete_beta(x, 2.5, 7) + incomplete_beta(1 - x, 7, 2.5), 1, 1e-13);
  }
}

// Computed apart from the project: the binomial tails as exact fractions, solved by bisection.
TEST(ClopperPearson, AgreesWithExactTails) {
  struct Case {
    std::uint64_t events, runs;
    double low, high;
  };
  for (const Case& one :
       {Case{0, 10, 0, 0.3084971}, Case{1, 10, 0.002528579, 0.4450161}, Case{5, 10, 0.187086, 0.812914},
        Case{10, 10, 0.6915029, 1}, Case{10, 100, 0.04900469, 0.1762226}}) {
    const Interval interval = clopper_pearson(one.events, one.runs);
    EXPECT_NEAR(interval.low, one.low, 1e-7) << one.events << " of " << one.runs;
    EXPECT_NEAR(interval.high, one.high, 1e-7) << one.events << " of " << one.runs;
  }
}

TEST(ClopperPearson, WithoutEventsHasTheClosedForm) {
  for (const std::uint64_t runs : {1ULL, 2ULL, 1000ULL, 1'000'000ULL, 1'000'000'000ULL}) {
    const double expected = -std::expm1(std::log(0.025) / static_cast<double>(runs));
    EXPECT_EQ(clopper_pearson(0, runs).low, 0);
    EXPECT_NEAR(clopper_pearson(0, runs).high / expected, 1, 1e-5) << runs;
    EXPECT_NEAR(1 - clopper_pearson(runs, runs).low, expected, 1e-5 * expected + 1e-15) << runs;
    EXPECT_EQ(clopper_pearson(runs, runs).high, 1);
  }
}

TEST(ClopperPearson, BoundsLeaveTwoAndAHalfPercentOutsideByDefinition) {
  for (const std::uint64_t runs : {3ULL, 50ULL, 1000ULL, 20'000ULL})
    for (const std::uint64_t events : std::vector<std::uint64_t>{1, runs / 3, runs / 2, runs - 1}) {
      const Interval interval = clopper_pearson(events, runs);
      EXPECT_NEAR(binomial(events, runs, runs, interval.low), 0.025, 1e-8) << events << " of " << runs;
      EXPECT_NEAR(binomial(0, events, runs, interval.high), 0.025, 1e-8) << events << " of " << runs;
      EXPECT_LT(interval.low, static_cast<double>(events) / static_cast<double>(runs));
      EXPECT_GT(interval.high, static_cast<double>(events) / static_cast<double>(runs));
    }
}

TEST(ClopperPearson, WithoutRunsNothingIsKnown) {
  EXPECT_EQ(clopper_pearson(0, 0).low, 0);
  EXPECT_EQ(clopper_pearson(0, 0).high, 1);
}

TEST(ClopperPearson, OfAThousandMillionRunsHasTheBoundsOfTheNormalDistribution) {
  const double runs = 1e9, share = 0.5, deviation = std::sqrt(share * (1 - share) / runs);
  const Interval interval = clopper_pearson(500'000'000, 1'000'000'000);
  EXPECT_NEAR((share - interval.low) / deviation, 1.959964, 1e-3);
  EXPECT_NEAR((interval.high - share) / deviation, 1.959964, 1e-3);
}

}  // namespace
}  // namespace tessera::statistics
