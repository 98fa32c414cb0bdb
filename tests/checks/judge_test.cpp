#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "checks/checks.hpp"
#include "checks/parser.hpp"
#include "points.hpp"

namespace tessera::checks_test {
namespace {

using checks::Check;
using checks::CheckResult;
using checks::Judge;
using ::testing::HasSubstr;

Check check(Check::When when, std::string_view text, std::optional<double> within_s = {}) {
  auto parsed = checks::parse_formula(text, checks::no_units);
  EXPECT_TRUE(parsed.value) << text << ": " << parsed.mistake.text;
  return {"it", when, *std::move(parsed.value), within_s, ""};
}

class JudgeOfChecks : public ::testing::Test {
 protected:
  JudgeOfChecks() {
    for (int n = 0; n < 3; ++n) points_.at["robot[" + std::to_string(n) + "]"] = {n * 2.0, 0, 0};
    points_.at["bin"] = {10, 0, 0};
    points_.at["clock"] = {0, 0, 0};
  }
  Judge judge(const Check& one) {
    Result<Judge> made = Judge::bind({one}, {}, points_);
    EXPECT_TRUE(made) << made.problem();
    return *std::move(made);
  }
  std::string problem(std::string_view text) {
    return Judge::bind({check(Check::When::never, text)}, {}, points_).problem();
  }
  CheckResult judged(const Check& one) {
    Judge made = judge(one);
    made.observe(0);
    made.finish(0);
    return made.results().front();
  }

  Points points_;
};

TEST_F(JudgeOfChecks, NeverFailsOnceAndKeepsTheFirstInstant) {
  Judge one = judge(check(Check::When::never, "contact(robot[*], robot[*])"));
  one.observe(1);
  EXPECT_TRUE(one.take_failures().empty());
  points_.touching = {{"robot[0]", "robot[2]"}};
  one.observe(2);
  one.observe(3);
  const auto failures = one.take_failures();
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0].time_s, 2);
  EXPECT_EQ(failures[0].detail, "robot[0], robot[2] touch");
  EXPECT_TRUE(one.take_failures().empty());
}

TEST_F(JudgeOfChecks, RunningIndicesStayWithinTheFleet) {
  EXPECT_EQ(judged(check(Check::When::always, "distance(robot[i], robot[i+1]) > 1")).verdict,
            CheckResult::Verdict::held);
  points_.at["robot[2]"] = {2.5, 0, 0};
  const CheckResult failed = judged(check(Check::When::always, "distance(robot[i], robot[i+1]) > 1"));
  EXPECT_EQ(failed.verdict, CheckResult::Verdict::failed);
  EXPECT_EQ(failed.detail, "i = 1: distance(robot[1], robot[2]) = 0.5 m");
  EXPECT_THAT(problem("distance(robot[i], robot[i+3]) > 1"), HasSubstr("no i"));
}

TEST_F(JudgeOfChecks, AllAndAnyRangeOverAGroup) {
  EXPECT_EQ(judged(check(Check::When::at_end, "any(inside(robot[*], bin))")).verdict,
            CheckResult::Verdict::failed);
  points_.at["robot[1]"] = {10, 0.5, 0};
  EXPECT_EQ(judged(check(Check::When::at_end, "any(inside(robot[*], bin))")).verdict,
            CheckResult::Verdict::held);
  const CheckResult all = judged(check(Check::When::at_end, "all(inside(robot[*], bin))"));
  EXPECT_EQ(all.verdict, CheckResult::Verdict::failed);
  EXPECT_EQ(all.detail, "inside(robot[0], bin) is false; inside(robot[2], bin) is false");
  // In a pair, the [*] keeps its meaning: the nearest two.
  EXPECT_EQ(judged(check(Check::When::always, "all(distance(robot[*], bin) < 11)")).verdict,
            CheckResult::Verdict::held);
}

TEST_F(JudgeOfChecks, EventuallyComesOrComesTooLateOrStaysOpen) {
  const Check soon = check(Check::When::eventually, "inside(robot[0], bin)", 5);
  Judge late = judge(soon);
  late.observe(4);
  late.observe(5.01);
  EXPECT_EQ(late.results().front().verdict, CheckResult::Verdict::failed);
  EXPECT_EQ(late.results().front().time_s, 5);

  Judge open = judge(soon);
  open.observe(3);
  open.finish(3);
  EXPECT_EQ(open.results().front().verdict, CheckResult::Verdict::open);

  Judge ever = judge(check(Check::When::eventually, "inside(robot[0], bin)"));
  ever.observe(3);
  ever.finish(3);
  EXPECT_EQ(ever.results().front().verdict, CheckResult::Verdict::failed);

  points_.at["robot[0]"] = {10, 0, 0};
  Judge came = judge(soon);
  came.observe(5);
  points_.at["robot[0]"] = {0, 0, 0};
  came.observe(6);
  came.finish(7);
  EXPECT_EQ(came.results().front().verdict, CheckResult::Verdict::held);
  EXPECT_EQ(came.results().front().time_s, 5);
}

TEST_F(JudgeOfChecks, MeasuresKeepLeastAndGreatest) {
  auto number = checks::parse_number("distance(robot[*], robot[*]) * 10", checks::no_units);
  ASSERT_TRUE(number.value);
  Result<Judge> made = Judge::bind({}, {{"nearest", *number.value}}, points_);
  ASSERT_TRUE(made) << made.problem();
  made->observe(0);
  points_.at["robot[1]"] = {0.5, 0, 0};
  made->observe(1);
  points_.at["robot[1]"] = {1.5, 0, 0};
  made->observe(2);
  const checks::MeasureResult& result = made->measures().front();
  EXPECT_EQ(result.samples, 3U);
  EXPECT_DOUBLE_EQ(result.least, 5);
  EXPECT_EQ(result.least_at_s, 1);
  EXPECT_DOUBLE_EQ(result.greatest, 20);
  EXPECT_DOUBLE_EQ(result.mean, 40.0 / 3);
  EXPECT_DOUBLE_EQ(result.last, 15);
}

TEST_F(JudgeOfChecks, WhatIsNotThereIsNamed) {
  EXPECT_THAT(problem("contact(rabbit)"), HasSubstr("no 'rabbit'"));
  EXPECT_THAT(problem("contact(box[*], robot[*])"),
              HasSubstr("no model is placed as box[...]; the world has: robot[*]"));
  EXPECT_THAT(problem("inside(robot[*], bin)"), HasSubstr("any(...) or all(...)"));
  EXPECT_THAT(problem("all(inside(bin, bin))"), HasSubstr("need a [*]"));
  EXPECT_THAT(problem("contact(robot[0], robot[0])"), HasSubstr("no pair"));
  EXPECT_THAT(problem("sensor(bin) > 1"), HasSubstr("gives 3 numbers"));
  EXPECT_THAT(problem("sensor(bin, 3) > 1"), HasSubstr("counted from 0"));
  EXPECT_EQ(problem("sensor(clock) > 1"), "");
  EXPECT_THAT(problem("all(inside(robot[*], bin) and any(inside(box[*], bin)))"), HasSubstr("one group"));
}

}  // namespace
}  // namespace tessera::checks_test
