// Percentiles of many runs with their intervals, and the sums of several machines.
#include "statistics/percentiles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "example_results.hpp"
#include "statistics/merge.hpp"
#include "statistics/table.hpp"

namespace tessera::statistics {
namespace {

TEST(Percentiles, HaveTheRanksOfTables) {
  // Conover, Practical Nonparametric Statistics, table of the binomial distribution: n = 20, median, 95 %: 6 and 15.
  const Ranks median = ranks_of_percentile(0.5, 20, 0.95);
  EXPECT_EQ(median.low, 6U);
  EXPECT_EQ(median.high, 15U);
  // 0.99^n is at most 0.025 from 368 samples on.
  EXPECT_FALSE(ranks_of_percentile(0.99, 367, 0.95).high);
  EXPECT_EQ(ranks_of_percentile(0.99, 368, 0.95).high, 368U);
  EXPECT_FALSE(ranks_of_percentile(0.5, 1, 0.95).low);
  EXPECT_FALSE(ranks_of_percentile(0.5, 1, 0.95).high);
}

TEST(Percentiles, OfManyExperimentsHoldTheTrueOne) {
  std::mt19937_64 random(1);
  constexpr int experiments = 2'000, runs = 150;
  const double truth = -std::log(0.1);  // 90 % of an exponential distribution
  int held = 0;
  for (int experiment = 0; experiment < experiments; ++experiment) {
    SampleCounts samples;
    for (int run = 0; run < runs; ++run)
      samples.add(-std::log1p(-std::generate_canonical<double, 53>(random)), 1);
    const Ranks ranks = ranks_of_percentile(0.9, runs, 0.95);
    // A value is good to 0.1 %.
    if (samples.at_rank(*ranks.low) <= truth * 1.001 && samples.at_rank(*ranks.high) >= truth * 0.999) ++held;
  }
  EXPECT_GE(held, experiments * 0.945);
  EXPECT_LE(held, experiments * 0.985);  // and they are not wider than needed
}

TEST(SampleCounts, KeepClassesInOrderAndValuesToATenthOfAPercent) {
  std::int64_t before = SampleCounts::class_of(0);
  EXPECT_EQ(SampleCounts::value_of(before), 0);
  for (double value = 1e-9; value < 1e12; value *= 1.01) {
    const std::int64_t now = SampleCounts::class_of(value);
    EXPECT_GT(now, before);
    EXPECT_NEAR(SampleCounts::value_of(now), value, value * 0.001);
    before = now;
  }
}

Results with_times(std::uint64_t begin, std::uint64_t end) {
  Results results = example_results(begin, end);
  results.ended_by_themselves = results.tried - results.failed;
  Distribution time{"time", "s", {}}, energy{"energy", "J", {}};
  for (std::uint64_t seed = begin; seed < end; ++seed) {
    if (seed % 10 == 0) continue;
    time.samples.add(static_cast<double>(1 + seed % 7), seed);
    energy.samples.add(static_cast<double>(seed % 3), seed);
  }
  results.distributions = {time, energy};
  return results;
}

TEST(Distributions, AreJoinedAndReadAgain) {
  const Result<Results> joined = merge({{"a", with_times(1, 101)}, {"b", with_times(101, 301)}});
  ASSERT_TRUE(joined);
  const Results whole = with_times(1, 301);
  EXPECT_EQ(joined->distributions[0].samples.parts().classes, whole.distributions[0].samples.parts().classes);
  EXPECT_EQ(distribution_rows(*joined), distribution_rows(whole));
  const Result<Results> again = parse_results(to_json(*joined));
  ASSERT_TRUE(again) << again.problem();
  EXPECT_EQ(to_json(*again), to_json(*joined));
}

TEST(Distributions, OfAnEarlierVersionAreNotInvented) {
  const Result<Results> joined = merge({{"a", with_times(1, 101)}, {"b", example_results(101, 301)}});
  ASSERT_TRUE(joined);
  EXPECT_FALSE(joined->ended_by_themselves);
}

TEST(Distributions, AreRefusedIfTheyContradictTheRuns) {
  std::string text = to_json(with_times(1, 101));
  const std::size_t at = text.find("\"runs\": 90,\n      \"sum\"");
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at + 8, 2, "91");
  EXPECT_FALSE(parse_results(text));
}

TEST(Distributions, AreRowsOfTheTable) {
  const std::string table = to_table(with_times(1, 301));
  EXPECT_NE(
      table.find(
          "270 of 300 runs ended by themselves within 1s; the others: 10 % (6.85 % to 14 %), of which 30 "
          "failed\n"),
      std::string::npos)
      << table;
  EXPECT_NE(table.find("\ntime, s "), std::string::npos) << table;
  EXPECT_NE(table.find("\nenergy, J "), std::string::npos) << table;
  EXPECT_NE(table.find("  least 1 (seed 7), greatest 7 (seed 6)\n"), std::string::npos) << table;
}

}  // namespace
}  // namespace tessera::statistics
