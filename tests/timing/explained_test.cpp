// The parts of a bound, and the effect of a single change.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "follower.hpp"
#include "timing/changes.hpp"
#include "timing/steps.hpp"

namespace tessera::timing {
namespace {

Time sum(const std::vector<Step>& steps) {
  Time all = 0;
  for (const Step& step : steps) {
    EXPECT_GT(step.time, 0);
    all += step.time;
  }
  return all;
}

Time part(const std::vector<Step>& steps, Step::Kind kind) {
  Time all = 0;
  for (const Step& step : steps)
    if (step.kind == kind) all += step.time;
  return all;
}

ChainSteps steps(const Judged& judged) {
  const Bounds bounds(judged.declared.system);
  return steps_of(bounds, judged.declared.chains.at(0).ways);
}

TEST(Steps, AddUpToTheBounds) {
  const std::string waits = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }";
  Follower shared;
  shared.sensor += ", realtime: { cpu: 0, priority: 53 }";
  shared.control += ", realtime: { cpu: 0, priority: 51 }";
  shared.motor += ", realtime: { cpu: 0, priority: 52 }";
  for (const Follower& follower : {Follower{}, Follower{.motion = no_waits}, Follower{.line = waits}, shared,
                                   Follower{.timing = "timing: { latency: 300 us }\n"}}) {
    const Judged judged(follower);
    ASSERT_TRUE(judged.reading.model) << judged.reading.report();
    const ChainSteps found = steps(judged);
    EXPECT_EQ(sum(found.age), judged.verdicts.at(0).bound.age);
    EXPECT_EQ(sum(found.reaction), judged.verdicts.at(0).bound.reaction);
  }
}

TEST(Steps, SayWhatTheTimeIsFor) {
  const ChainSteps plain = steps(Judged({}));
  EXPECT_EQ(part(plain.age, Step::Kind::takes), 12 * ms);  // 2 + 8 + 2
  EXPECT_EQ(part(plain.reaction, Step::Kind::takes), 12 * ms);
  EXPECT_EQ(part(plain.reaction, Step::Kind::next_reading), 20 * ms);
  EXPECT_EQ(part(plain.age, Step::Kind::latency), 0);
  const ChainSteps late = steps(Judged({.motion = no_waits, .timing = "timing: { latency: 300 us }\n"}));
  EXPECT_EQ(part(late.age, Step::Kind::latency), 3 * 300'000);
  Follower shared{.motion = no_waits};
  shared.sensor += ", realtime: { cpu: 0, priority: 53 }";
  shared.control += ", realtime: { cpu: 0, priority: 51 }";
  EXPECT_EQ(part(steps(Judged(shared)).age, Step::Kind::processor), 2 * ms);  // control after sensor
}

const Change* find(const std::vector<Change>& changes, Change::Kind kind, std::uint32_t subsystem) {
  const auto found = std::ranges::find_if(
      changes, [&](const Change& change) { return change.kind == kind && change.subsystem == subsystem; });
  return found == changes.end() ? nullptr : &*found;
}

std::uint32_t number(const Judged& judged, const std::string& path) {
  for (const spec::InstanceId id : judged.reading.model->instances.ids())
    if (judged.reading.model->instance_path(id) == path) return id.value;
  ADD_FAILURE() << path;
  return 0;
}

TEST(Changes, HaveTheBoundsOfTheChangedSpecification) {
  const Judged judged({});
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  const std::vector<Change> changes = changes_for(judged.declared, judged.declared.chains.at(0));
  ASSERT_FALSE(changes.empty());
  struct Case {
    Change::Kind kind;
    std::string subsystem;
    Follower changed;
  };
  const std::string waits = "{ from: \"robot.sensor.line\", to: \"robot.control.line\", receive: blocking }";
  for (const Case& one : {
           Case{Change::Kind::twice_the_rate, "robot.control", {.control = "rate: 40 Hz"}},
           Case{Change::Kind::twice_the_rate, "robot.sensor", {.sensor = "rate: 100 Hz"}},
           Case{Change::Kind::event_driven, "robot.motor", {.motor = "stale: never"}},
           Case{Change::Kind::event_driven, "robot.control", {.control = "memory: {}", .line = waits}},
       }) {
    SCOPED_TRACE(one.subsystem);
    const Change* const change = find(changes, one.kind, number(judged, one.subsystem));
    const Judged changed(one.changed);
    ASSERT_TRUE(changed.reading.model) << changed.reading.report();
    const ChainBound& bound = changed.verdicts.at(0).bound;
    const ChainBound& now = judged.verdicts.at(0).bound;
    if (bound.age > now.age || bound.reaction > now.reaction) {
      EXPECT_EQ(change, nullptr);
      continue;
    }
    ASSERT_NE(change, nullptr);
    EXPECT_EQ(change->age, bound.age);
    EXPECT_EQ(change->reaction, bound.reaction);
  }
  // The one that helps most is the first one.
  for (const Change& change : changes) EXPECT_GE(change.reaction, changes.front().reaction);
}

TEST(Changes, OfAChainInAFleetAreThoseOfOneAgent) {
  Follower fleet{.count = "    count: 20\n"};
  for (std::string* const channel : {&fleet.line, &fleet.motion})
    for (std::size_t at = 0; (at = channel->find("robot.", at)) != std::string::npos; at += 9)
      channel->replace(at, 6, "robot[i].");
  const Judged one({}), all(fleet);
  ASSERT_TRUE(all.reading.model) << all.reading.report();
  const std::vector<Change> single = changes_for(one.declared, one.declared.chains.at(0)),
                            member = changes_for(all.declared, all.declared.chains.at(7));
  ASSERT_EQ(single.size(), member.size());
  for (std::size_t at = 0; at < single.size(); ++at) {
    EXPECT_EQ(single[at].kind, member[at].kind);
    EXPECT_EQ(single[at].age, member[at].age);
    EXPECT_EQ(single[at].reaction, member[at].reaction);
    EXPECT_EQ(all.declared.chains[7].path.front().value / 3, member[at].subsystem / 3);
  }
}

TEST(Changes, AndBoundsStopWhenAsked) {
  const Judged judged({});
  ASSERT_TRUE(judged.reading.model) << judged.reading.report();
  EXPECT_THROW(Bounds(judged.declared.system, [] { return true; }), Interrupted);
  EXPECT_THROW(
      static_cast<void>(changes_for(judged.declared, judged.declared.chains.at(0), [] { return true; })),
      Interrupted);
  int asked = 0;
  const Bounds bounds(judged.declared.system, [&] { return ++asked > 1'000'000; });
  EXPECT_GT(asked, 10);
}

}  // namespace
}  // namespace tessera::timing
