#include "replay/timeline.hpp"

#include <gtest/gtest.h>

#include "constructed.hpp"

using tessera::replay::Lane;
using tessera::replay::thinned;
using tessera::replay::timeline_of;

namespace {

TEST(Timeline, ABehaviourRunsFromItsEntryToItsInitialCondition) {
  Constructed run({"robot.control"});
  run.fire(0.1, 0, "t_in")
      .fire(0.2, 0, "init.t1")
      .fire(0.5, 0, "t_init_1")
      .fire(0.6, 0, "follow_line.t1")
      .fire(2, 0, "follow_line.t1");
  run.fire(3, 0, "t_follow_line_2").fire(4, 0, "search.t1").fire(5, 0, "search.t6");
  const auto timeline = timeline_of(run.recording);
  ASSERT_EQ(timeline.lanes.size(), 1U);
  const Lane& lane = timeline.lanes[0];
  EXPECT_EQ(lane.behaviours, (std::vector<std::string>{"init", "follow_line", "search"}));
  ASSERT_EQ(lane.stretches.size(), 3U);
  EXPECT_DOUBLE_EQ(lane.stretches[0].from_s, 0.1);
  EXPECT_DOUBLE_EQ(lane.stretches[1].from_s, 0.5);
  EXPECT_DOUBLE_EQ(lane.stretches[1].to_s, 3);
  EXPECT_DOUBLE_EQ(lane.stretches[2].to_s, 5);
  EXPECT_EQ(lane.iterations, 4U);
  EXPECT_EQ(lane.errors_s, std::vector<double>{5});
}

TEST(Timeline, ASubsystemThatEndedHasNoStretchAfterwards) {
  Constructed run({"a.b"});
  run.fire(0, 0, "t_in").fire(0, 0, "go.t1").fire(1, 0, "t_go_1").log(9, 0, 0, "late");
  const auto timeline = timeline_of(run.recording);
  ASSERT_EQ(timeline.lanes[0].stretches.size(), 1U);
  EXPECT_DOUBLE_EQ(timeline.lanes[0].stretches[0].to_s, 1);
  EXPECT_DOUBLE_EQ(timeline.end_s, 9);
}

TEST(Timeline, CommunicationDoesNotCountAsIteration) {
  Constructed run({"a.b"});
  run.fire(0, 0, "t_in").fire(1, 0, "go.t1").fire(1, 0, "go.snd.t1").fire(2, 0, "go.rcv.x.t6");
  const auto timeline = timeline_of(run.recording);
  EXPECT_EQ(timeline.lanes[0].iterations, 1U);
  EXPECT_TRUE(timeline.lanes[0].errors_s.empty());
}

TEST(Timeline, BrokenReferencesAreIgnored) {
  Constructed run({"a.b"});
  run.fire(0, 0, "t_in").fire(1, 0, "go.t1");
  run.recording.entries.push_back({{.time_ns = 5, .subject = 99, .origin = 1}, {}});
  run.recording.transitions.push_back({"t_in", tessera::system_instance});
  run.recording.entries.push_back({{.time_ns = 5, .subject = 2, .origin = 1}, {}});
  EXPECT_EQ(timeline_of(run.recording).lanes[0].iterations, 1U);
}

TEST(Timeline, ThinningKeepsWhatRanLongest) {
  Constructed run({"a.b"});
  run.fire(0, 0, "t_in");
  for (int i = 0; i < 1000; ++i) {
    const std::string now = i % 2 == 0 ? "long" : "short";
    run.fire(i, 0, now + ".t1").fire(i + (i % 2 == 0 ? 1 : 0.1), 0, "t_" + now + "_1");
  }
  const auto timeline = timeline_of(run.recording);
  const auto few = thinned(timeline.lanes[0], timeline.end_s, 50);
  ASSERT_FALSE(few.empty());
  EXPECT_LE(few.size(), 50U);
  EXPECT_DOUBLE_EQ(few.front().from_s, 0);
  EXPECT_NEAR(few.back().to_s, timeline.end_s, 1e-6);
}

}  // namespace
