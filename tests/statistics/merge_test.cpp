#include "statistics/merge.hpp"

#include <gtest/gtest.h>

#include "example_results.hpp"

namespace tessera::statistics {
namespace {

using Names = std::vector<std::string>;

std::string problem_of(Results one, Results other, bool other_builds = false) {
  const Result<Results> merged =
      merge({{"a.json", std::move(one)}, {"b.json", std::move(other)}}, other_builds);
  return merged ? "" : merged.problem();
}

TEST(Merge, OfAllPartsIsTheWholeInAnyOrder) {
  const Result<Results> merged = merge(
      {{"2", example_results(101, 201)}, {"3", example_results(201, 301)}, {"1", example_results(1, 101)}});
  ASSERT_TRUE(merged) << merged.problem();
  Results whole = example_results(1, 301);
  whole.wall_s = 1.5;
  EXPECT_EQ(to_json(*merged), to_json(whole));
  EXPECT_TRUE(missing_parts(*merged).empty());
}

TEST(Merge, OfMergedResultsIsTheSame) {
  const Result<Results> two = merge({{"1", example_results(1, 101)}, {"3", example_results(201, 301)}});
  ASSERT_TRUE(two);
  EXPECT_EQ(missing_parts(*two), (Names{"part 2/3: seeds 101 to 200"}));
  const Result<Results> all = merge({{"13", *two}, {"2", example_results(101, 201)}});
  ASSERT_TRUE(all) << all.problem();
  EXPECT_EQ(all->failed, 30u);
  EXPECT_EQ(all->failure->seed, 10u);
}

TEST(Merge, AddsTheRunsWithAPlantedFault) {
  Results one = example_results(1, 101), other = example_results(101, 201);
  one.injected = {{"a:nan@any", 90, 10}};
  other.injected = {{"a:nan@any", 70, 29}};
  const Result<Results> merged = merge({{"1", one}, {"2", other}});
  ASSERT_TRUE(merged);
  ASSERT_EQ(merged->injected.size(), 1U);
  EXPECT_EQ(merged->injected[0].runs, 160U);
  EXPECT_EQ(merged->injected[0].missed, 39U);
}

TEST(Merge, NamesThePartsThatAreMissingOrNotWhole) {
  const Result<Results> merged = merge({{"1", example_results(1, 90)}, {"2", example_results(101, 102)}});
  ASSERT_TRUE(merged);
  EXPECT_EQ(missing_parts(*merged),
            (Names{"part 1/3: seeds 90 to 100", "part 2/3: seeds 102 to 200", "part 3/3: seeds 201 to 300"}));
}

TEST(Merge, OfOneThatWasGoneOnWithHasTheSeedsOfBoth) {
  Results more = example_results(1, 101);
  more.whole = {301, 401};
  more.parts = 1;
  more.ran = {{301, 401}};
  more.failure->seed = 310;
  const Result<Results> merged = merge({{"1", example_results(1, 301)}, {"more", more}});
  ASSERT_TRUE(merged) << merged.problem();
  EXPECT_EQ(merged->tried, 400u);
  EXPECT_EQ(merged->whole, (Seeds{1, 401}));
  EXPECT_TRUE(missing_parts(*merged).empty());
}

TEST(Merge, RefusesSeedsThatAreInTwo) {
  const std::string problem = problem_of(example_results(1, 101), example_results(100, 120));
  EXPECT_EQ(problem, "a.json and b.json both have seed 100, which would be counted twice");
}

TEST(Merge, RefusesOtherNetsSettingsAndPrograms) {
  const Results one = example_results(1, 101);
  Results other = example_results(101, 201);
  other.identity.net = "n2";
  EXPECT_NE(problem_of(one, other).find("the nets 'n1' and 'n2'"), std::string::npos);
  other.identity = one.identity;
  other.identity.settings["inject"] = "robot:nan@any";
  EXPECT_NE(problem_of(one, other).find("`inject`: nothing and 'robot:nan@any'"), std::string::npos);
  other.identity = one.identity;
  other.identity.controller = "c2";
  EXPECT_NE(problem_of(one, other).find("--other-builds"), std::string::npos);
  EXPECT_EQ(problem_of(one, other, /*other_builds=*/true), "");
  other.identity.specification = "s2";
  EXPECT_NE(problem_of(one, other, /*other_builds=*/true), "");
}

TEST(Merge, CountsFiringsOnlyIfAllDid) {
  Results without = example_results(101, 201);
  without.transitions.clear();
  const Result<Results> some = merge({{"1", example_results(1, 101)}, {"2", without}});
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->transitions.empty());
  const Result<Results> none = merge({{"1", example_results(1, 101)}, {"2", example_results(101, 101)}});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->transitions.at("t_in"), 100u);
}

}  // namespace
}  // namespace tessera::statistics
