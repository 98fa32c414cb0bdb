#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "explore/explore.hpp"
#include "small_nets.hpp"

namespace tessera::explore {
namespace {

using Kind = Answer::Kind;

TEST(Limits, MarkingsEndAnUnboundedNet) {
  Limits limits;
  limits.markings = 5000;
  const Count counted = count(PtNet(spring()), limits);
  EXPECT_FALSE(counted.complete);
  EXPECT_EQ(counted.why, "the limit of 5000 markings is reached");
  EXPECT_GT(counted.markings, 4000U);
  EXPECT_GT(counted.most_tokens, 4000U);
}

TEST(Limits, TimeEndsIt) {
  Limits limits;
  limits.time = std::chrono::seconds(0);
  const Answer answer = always_reachable(PtNet(ring_of(3, 1)), Formula::always(), limits);
  EXPECT_EQ(answer.kind, Kind::unknown);
  EXPECT_EQ(answer.why, "the time limit of 0 s is reached");
}

TEST(Limits, MemoryEndsIt) {
  Limits limits;
  limits.bytes = 1U << 20U;
  const Count counted = count(PtNet(ring_of(9, 30)), limits);
  EXPECT_FALSE(counted.complete);
  EXPECT_EQ(counted.why, "the memory limit of 1 MB is reached");
  EXPECT_LE(counted.effort.bytes, limits.bytes);
  EXPECT_GT(counted.markings, 10'000U);
}

TEST(Limits, AStopEndsEveryQuestion) {
  const std::atomic<bool> stop = true;
  Limits limits;
  limits.stop = &stop;
  const PtNet net(philosophers(3));
  const Formula goal = Formula::at_least(PlaceId{0}, 7);
  EXPECT_EQ(count(net, limits).why, "it was interrupted");
  EXPECT_EQ(find(net, goal, limits).why, "it was interrupted");
  EXPECT_EQ(always_reachable(net, goal, limits).why, "it was interrupted");
  EXPECT_EQ(leads_to(net, goal, goal, limits).why, "it was interrupted");
  EXPECT_EQ(can_always_fire(net, {{}}, limits).at(0).why, "it was interrupted");
  EXPECT_EQ(find_deadlock(net, Formula::always(), limits).why, "it was interrupted");
}

TEST(Limits, ProgressIsReportedUntilTheEnd) {
  std::vector<Progress> reports;
  std::atomic<bool> stop = false;
  Limits limits;
  limits.stop = &stop;
  limits.progress = [&](const Progress& progress) {
    reports.push_back(progress);
    stop = reports.size() == 2;  // the net itself has no end
  };
  const Count counted = count(PtNet(ring_of(16, 60)), limits);
  EXPECT_FALSE(counted.complete);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_GT(reports[1].markings, reports[0].markings);
  EXPECT_GT(reports[1].markings_per_second, 0);
  EXPECT_GT(reports[1].bytes, reports[0].bytes);
  EXPECT_GT(reports[1].elapsed, reports[0].elapsed);
}

}  // namespace
}  // namespace tessera::explore
