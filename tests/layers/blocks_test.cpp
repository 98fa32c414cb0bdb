#include <gmock/gmock.h>

#include "layers/models.hpp"

namespace tessera::test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

struct BlockCase {
  const char* name;
  Modes modes;
  std::vector<std::string> snd, rcv;
};

// docs/theory/paper.md, communication: every block, arc by arc.
const std::vector<BlockCase> block_cases{
    {"NB -> NB",
     {N, N},
     {"y1.t1: in + y1.channel -> y1.2", "y1.t2: y1.2 -> out + y1.channel"},
     {"x1.t1: in + x1.channel -> x1.2", "x1.t2: x1.2 -> out + x1.channel"}},
    {"NB -> B",
     {N, B},
     {"y1.t1: in + y1.empty -> y1.2", "y1.t1o: in + y1.full -> y1.2", "y1.t2: y1.2 -> out + y1.full"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.empty"}},
    {"NB -> B, receive timeout",
     {N, B, false, true},
     {"y1.t1: in + y1.empty -> y1.2", "y1.t1o: in + y1.full -> y1.2", "y1.t2: y1.2 -> out + y1.full"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.empty",
      "x1.timeout: in + x1.empty -> out + x1.empty [2 s]"}},
    {"NB -> B once, receive timeout",
     {N, spec::Mode::blocking_once, false, true},
     {"y1.t1: in + y1.empty -> y1.2", "y1.replace: in + y1.full -> y1.2", "y1.t2: y1.2 -> out + y1.full"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.full",
      "x1.timeout: in + x1.empty -> out + x1.empty [2 s]"}},
    {"B -> NB, send timeout",
     {B, N, true, false},
     {"y1.t1: in + y1.empty -> y1.2", "y1.t2: y1.2 -> y1.wait + y1.full", "y1.t3: y1.wait + y1.ack -> out",
      "y1.timeout: y1.wait + y1.full -> out + y1.empty [1500 ms]"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.empty + x1.ack",
      "x1.skip: in + x1.empty -> out + x1.empty"}},
    {"B -> B",
     {B, B},
     {"y1.t1: in + y1.empty -> y1.2", "y1.t2: y1.2 -> y1.wait + y1.full", "y1.t3: y1.wait + y1.ack -> out"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.empty + x1.ack"}},
    {"B -> B, receive timeout",
     {B, B, false, true},
     {"y1.t1: in + y1.empty -> y1.2", "y1.t2: y1.2 -> y1.wait + y1.full", "y1.t3: y1.wait + y1.ack -> out"},
     {"x1.t1: in + x1.full -> x1.2", "x1.t2: x1.2 -> out + x1.empty + x1.ack",
      "x1.timeout: in + x1.empty -> out + x1.empty [2 s]"}},
};

TEST(Blocks, HaveTheArcsOfTheirModes) {
  for (const BlockCase& expected : block_cases) {
    SCOPED_TRACE(expected.name);
    const Built built = build(pair({expected.modes}));
    EXPECT_THAT(transitions_of(built.pages, "a.control.give.snd"), ElementsAreArray(expected.snd));
    EXPECT_THAT(transitions_of(built.pages, "a.motor.take.rcv"), ElementsAreArray(expected.rcv));
  }
}

/// The sending transitions of a case if iterations may skip the output.
std::vector<std::string> with_skip(const std::vector<std::string>& snd, const std::string& sends,
                                   const std::string& skips) {
  std::vector<std::string> all{"y1.skip: in -> out [" + skips + "]"};
  for (const std::string& transition : snd)
    all.push_back(transition + (transition.find(": in ") == std::string::npos ? "" : " [" + sends + "]"));
  return all;
}

TEST(Blocks, ThatMayBeSkippedHaveAWayPastTheChannel) {
  for (const BlockCase& expected : block_cases) {
    SCOPED_TRACE(expected.name);
    spec::Model model = pair({expected.modes});
    spec::Behaviour& give = model.definitions[0].subsystems[0].behaviours[0];
    give.skippable.push_back({.output = {0}, .by_function = true});
    const Built by_function = build(model);
    EXPECT_THAT(transitions_of(by_function.pages, "a.control.give.snd"),
                ElementsAreArray(with_skip(expected.snd, "not skipped", "skipped")));
    EXPECT_THAT(transitions_of(by_function.pages, "a.motor.take.rcv"), ElementsAreArray(expected.rcv));

    give.skippable.front().by_function = false;
    give.skippable.front().when.kind = spec::Condition::Kind::expressions;
    give.skippable.front().when.expressions.push_back({"", "memory.ask", {}});
    EXPECT_THAT(transitions_of(build(model).pages, "a.control.give.snd"),
                ElementsAreArray(with_skip(expected.snd, "memory.ask", "not (memory.ask)")));
  }
}

TEST(Blocks, SideBySideAreSkippedEachAlone) {
  spec::Model model = pair({{N, B}, {B, B}}, spec::Transfer::parallel);
  model.definitions[0].subsystems[0].behaviours[0].skippable.push_back({.output = {1}, .by_function = true});
  EXPECT_THAT(transitions_of(build(model).pages, "a.control.give.snd"),
              testing::AllOf(testing::Contains("y2.skip: y2.in -> y2.out [skipped]"),
                             testing::Not(testing::Contains(testing::HasSubstr("y1.skip")))));
}

/// The known values decide: only the ways that are possible with a value are drawn for it.
TEST(Blocks, AreSkippedByValuesOfMemory) {
  spec::Model model = pair({{B, B, true, false}});
  spec::Subsystem& control = model.definitions[0].subsystems[0];
  spec::Field mode{.name = "mode", .type = {}};
  mode.few = spec::FewValues{};
  mode.few->names = {"quiet", "loud"};
  control.memory.push_back(mode);
  spec::Behaviour& give = control.behaviours[0];
  give.skippable.push_back({.output = {0}});
  give.skippable.front().when.kind = spec::Condition::Kind::expressions;
  give.skippable.front().when.expressions.push_back({"", "memory.mode == loud", {}});
  give.terminal.kind = spec::Condition::Kind::expressions;
  give.terminal.expressions.push_back({"", "out.y1.timed_out", {}});
  std::vector<std::string> begun;
  for (const std::string& transition : transitions_of(build(model).pages, "a.control.give.snd"))
    if (transition.find("skip") != std::string::npos || transition.starts_with("y1.t1"))
      begun.push_back(transition.substr(0, transition.find(':')));
  EXPECT_THAT(begun, ElementsAre("y1.skip.y1.in_time.memory.mode.quiet",
                                 "y1.skip.y1.timed_out.memory.mode.quiet", "y1.t1.memory.mode.loud"));
}

TEST(Blocks, InSequenceShareOutputAndInputPlaces) {
  const Built built = build(pair({{N, N}, {N, N}, {B, B}}));
  EXPECT_THAT(places_of(built.pages, "a.control.give.snd"),
              ElementsAre("in", "y1.2", "y1.out", "y2.2", "y2.out", "y3.2", "y3.wait", "out"));
  EXPECT_THAT(transitions_of(built.pages, "a.control.give.snd"),
              ElementsAre("y1.t1: in + y1.channel -> y1.2", "y1.t2: y1.2 -> y1.out + y1.channel",
                          "y2.t1: y1.out + y2.channel -> y2.2", "y2.t2: y2.2 -> y2.out + y2.channel",
                          "y3.t1: y2.out + y3.empty -> y3.2", "y3.t2: y3.2 -> y3.wait + y3.full",
                          "y3.t3: y3.wait + y3.ack -> out"));
}

TEST(Blocks, InParallelRunBetweenForkAndJoin) {
  const Built built = build(pair({{N, N}, {N, B}}, spec::Transfer::parallel));
  EXPECT_THAT(places_of(built.pages, "a.motor.take.rcv"),
              ElementsAre("in", "x1.in", "x1.2", "x1.out", "x2.in", "x2.2", "x2.out", "out"));
  EXPECT_THAT(transitions_of(built.pages, "a.motor.take.rcv"),
              ElementsAre("x1.t1: x1.in + x1.channel -> x1.2", "x1.t2: x1.2 -> x1.out + x1.channel",
                          "x2.t1: x2.in + x2.full -> x2.2", "x2.t2: x2.2 -> x2.out + x2.empty",
                          "fork: in -> x1.in + x2.in", "join: x1.out + x2.out -> out"));
}

TEST(Blocks, OfAnOutputWithTwoChannelsAreNumbered) {
  ModelBuilder builder;
  builder.agent("a", {subsystem(spec::SubsystemKind::control, "control", {}, {"u", "v"}, {behaviour("give")}),
                      subsystem(spec::SubsystemKind::effector, "m", {"x"}, {}, {behaviour("take")}),
                      subsystem(spec::SubsystemKind::effector, "n", {"x", "y"}, {}, {behaviour("take")})});
  builder.channel({{0}, {0}}, {{1}, {0}});
  builder.channel({{0}, {1}}, {{2}, {1}});
  builder.channel({{0}, {0}}, {{2}, {0}});
  const Built built = build(builder.result());
  EXPECT_THAT(places_of(built.pages, "a.control.give.snd"),
              ElementsAre("in", "u#1.2", "u#1.out", "v.2", "v.out", "u#2.2", "out"));
  EXPECT_THAT(places_of(built.pages, "a.n.take.rcv"), ElementsAre("in", "y.2", "y.out", "x.2", "out"));
}

TEST(Blocks, FollowTheListOfTheBehaviour) {
  spec::Model model = pair({{N, N}, {N, N}, {N, N}});
  model.definitions[0].subsystems[0].behaviours[0].send = std::vector<spec::BufferId>{{2}, {0}};
  model.definitions[0].subsystems[1].behaviours[0].receive = std::vector<spec::BufferId>{};
  const Built built = build(model);
  EXPECT_THAT(places_of(built.pages, "a.control.give.snd"),
              ElementsAre("in", "y3.2", "y3.out", "y1.2", "out"));
  EXPECT_THAT(places_of(built.pages, "a.motor.take.rcv"), ElementsAre("in", "out"));
}

TEST(Blocks, OfAChannelNobodyUsesHaveNoPlaces) {
  spec::Model model = pair({{N, N}, {B, B}});
  model.definitions[0].subsystems[0].behaviours[0].send = std::vector<spec::BufferId>{{0}};
  model.definitions[0].subsystems[1].behaviours[0].receive = std::vector<spec::BufferId>{{0}};
  const Built built = build(model);
  ASSERT_EQ(built.pages.fusions.size(), 1U);
  EXPECT_EQ(built.pages.fusions[0].name, "a.control.y1->a.motor.x1.channel");
}

TEST(Blocks, OfOneChannelShareItsFusedPlacesAmongAllBehaviours) {
  const Built built = build(line_follower());
  std::size_t members = 0;
  for (const net::Page& page : built.pages.pages)
    for (const net::Node& node : page.nodes)
      members += node.fusion.valid() && built.pages.fusions[node.fusion.value].name ==
                                            "robot.control.motion->robot.motor.velocity.full";
  EXPECT_EQ(members, 3U) << "init.snd, follow.snd and drive.rcv";
  std::size_t places = 0;
  for (const net::Place& place : built.net.places())
    places += place.name == "robot.control.motion->robot.motor.velocity.full";
  EXPECT_EQ(places, 1U);
}

TEST(Blocks, CarryTheirOperationsAndChannels) {
  const Built built = build(pair({{N, N}, {N, B}}));
  std::vector<std::string> operations;
  for (const net::Place& place : built.net.places())
    if (place.operation.kind == net::Operation::Kind::write ||
        place.operation.kind == net::Operation::Kind::read)
      operations.push_back(place.name + " " + std::to_string(place.operation.channel.value));
  EXPECT_THAT(operations, ElementsAre("a.control.give.snd.y1.2 0", "a.control.give.snd.y2.2 1",
                                      "a.motor.take.rcv.x1.2 0", "a.motor.take.rcv.x2.2 1"));
}

}  // namespace
}  // namespace tessera::test
