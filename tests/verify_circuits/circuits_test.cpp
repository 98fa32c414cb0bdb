#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "verify_circuits/judged.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::test {
namespace {

using verify::Answer;
using Cause = verify::CircuitGroup::Cause;
using Ends = SystemBuilder::Ends;

constexpr Ends both_block{true, true}, receiver_blocks{false, true}, sender_blocks{true, false};

/// The first group with a result, in words.
std::string story(const Judged& judged) {
  for (const verify::CircuitGroup& group : judged.report.groups) {
    if (!group.applies()) return group.why_not;
    if (!group.circuit.empty()) return verify::in_words(judged.structure, group);
  }
  return "";
}

struct Pair {
  SystemBuilder system;
  spec::InstanceId a = system.subsystem(), b = system.subsystem();
};

/// Two subsystems that each send and then receive.
Judged exchange(Ends there, Ends back) {
  Pair pair;
  const auto x = pair.system.channel(pair.a, pair.b, there), y = pair.system.channel(pair.b, pair.a, back);
  pair.system.behaviour(pair.a, {x}, {y});
  pair.system.behaviour(pair.b, {y}, {x});
  return judge(pair.system.result());
}

TEST(Circuits, CrossedSendsThatWaitAreNamedAsWhoWaitsForWhom) {
  const Judged judged = exchange(both_block, both_block);
  EXPECT_EQ(judged.report.goes_on, Answer::no);
  EXPECT_EQ(judged.report.deadlock_free, Answer::no);
  EXPECT_EQ(judged.report.channels_flow, Answer::no);
  EXPECT_EQ(judged.report.groups.front().cause, Cause::no_token);
  EXPECT_EQ(story(judged),
            "a0.s0 waits for the acknowledgement of a0.s0.y0->a1.s1.x0 from a1.s1; "
            "a1.s1 waits for the acknowledgement of a1.s1.y1->a0.s0.x1 from a0.s0");
}

TEST(Circuits, SendingBeforeReceivingIsTheTokenThatCrossedReceivesNeed) {
  const Judged judged = exchange(receiver_blocks, receiver_blocks);
  EXPECT_EQ(judged.report.goes_on, Answer::yes);
  EXPECT_EQ(judged.report.deadlock_free, Answer::yes);
  EXPECT_EQ(judged.report.channels_flow, Answer::yes);
}

TEST(Circuits, CrossedReceivesNeedOneThatSendsFirst) {
  for (const bool both : {false, true}) {
    Pair pair;
    const auto x = pair.system.channel(pair.a, pair.b, receiver_blocks);
    const auto y = pair.system.channel(pair.b, pair.a, receiver_blocks);
    pair.system.behaviour(pair.a, {x}, {y});
    pair.system.behaviour(pair.b, {y}, {x});
    pair.system.receive_first(pair.a);
    if (both) pair.system.receive_first(pair.b);
    const Judged judged = judge(pair.system.result());
    EXPECT_EQ(judged.report.goes_on, both ? Answer::no : Answer::yes);
    EXPECT_EQ(judged.report.deadlock_free, both ? Answer::no : Answer::yes);
    if (!both) continue;
    EXPECT_EQ(judged.report.groups.front().cause, Cause::no_token);
    EXPECT_EQ(story(judged),
              "a0.s0 waits for a value of a1.s1.y1->a0.s0.x1 from a1.s1; "
              "a1.s1 waits for a value of a0.s0.y0->a1.s1.x0 from a0.s0");
  }
}

TEST(Circuits, ASkipThatLosesTheTokenIsFound) {
  Pair pair;
  const auto there = pair.system.channel(pair.a, pair.b, sender_blocks);  // b may skip
  const auto back = pair.system.channel(pair.a, pair.b, receiver_blocks);
  pair.system.behaviour(pair.a, {there, back}, {});
  pair.system.behaviour(pair.b, {}, {there, back});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::no);
  EXPECT_EQ(judged.report.groups.front().cause, Cause::lost_token);
  EXPECT_EQ(judged.report.groups.front().stuck.size(), 2U);
}

TEST(Circuits, OnlyTimeoutsAtBothEndsBreakACrossedWait) {
  const Ends sender{true, true, true, false}, receiver{true, true, false, true}, both{true, true, true, true};
  EXPECT_EQ(exchange(sender, sender).report.goes_on, Answer::no);
  EXPECT_EQ(exchange(receiver, receiver).report.goes_on, Answer::no);
  EXPECT_EQ(exchange(both, both).report.goes_on, Answer::yes);
}

TEST(Circuits, OneStuckAgentAmongRunningOnesIsFoundThoughNothingDeadlocks) {
  Pair pair;
  const auto x = pair.system.channel(pair.a, pair.b, both_block);
  const auto y = pair.system.channel(pair.b, pair.a, both_block);
  pair.system.behaviour(pair.a, {x}, {y});
  pair.system.behaviour(pair.b, {y}, {x});
  const auto free = pair.system.subsystem();
  pair.system.behaviour(free, {}, {});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::no);
  EXPECT_EQ(judged.report.deadlock_free, Answer::yes);
}

TEST(Circuits, AStartUpThatSendsFirstIsTheMissingToken) {
  for (const bool primed : {false, true}) {
    Pair pair;
    const auto x = pair.system.channel(pair.a, pair.b, both_block);
    const auto y = pair.system.channel(pair.a, pair.b, receiver_blocks);
    if (primed) pair.system.leave(pair.a, pair.system.behaviour(pair.a, {y}, {}), true, {{1}});
    pair.system.behaviour(pair.a, {x, y}, {});
    pair.system.behaviour(pair.b, {}, {y, x});
    EXPECT_EQ(judge(pair.system.result()).report.goes_on, primed ? Answer::yes : Answer::no);
  }
}

TEST(Circuits, AParallelTransferWaitsForAllAtOnce) {
  for (const auto transfer : {spec::Transfer::sequential, spec::Transfer::parallel}) {
    Pair pair;
    const auto x = pair.system.channel(pair.a, pair.b, both_block),
               y = pair.system.channel(pair.a, pair.b, both_block);
    pair.system.behaviour(pair.a, {x, y}, {}, transfer);
    pair.system.behaviour(pair.b, {}, {y, x});
    EXPECT_EQ(judge(pair.system.result()).report.goes_on,
              transfer == spec::Transfer::parallel ? Answer::yes : Answer::no);
  }
}

TEST(Circuits, WhoWaitsForAPeerThatMayEndOrIsAbsentIsStuck) {
  Pair pair;
  const auto x = pair.system.channel(pair.a, pair.b, receiver_blocks);
  pair.system.leave(pair.a, pair.system.behaviour(pair.a, {x}, {}), false, {spec::BehaviourId{}});
  pair.system.behaviour(pair.b, {}, {x});
  const Judged ending = judge(pair.system.result());
  EXPECT_EQ(ending.report.groups.front().cause, Cause::peer_ended);
  EXPECT_EQ(ending.report.groups.front().stuck,
            std::vector<verify::SubsystemFlowId>{verify::SubsystemFlowId{1}});
  EXPECT_EQ(ending.report.deadlock_free, Answer::no);

  Pair silent;
  const auto y = silent.system.channel(silent.a, silent.b, receiver_blocks);
  silent.system.behaviour(silent.a, {}, {});
  silent.system.behaviour(silent.b, {}, {y});
  const Judged absent = judge(silent.system.result());
  EXPECT_EQ(absent.report.groups.front().cause, Cause::none);
  EXPECT_EQ(absent.report.groups.back().cause, Cause::peer_absent);
  EXPECT_EQ(
      story(absent),
      "a1.s1 waits for a value of a0.s0.y0->a1.s1.x0 from a0.s0, and no behaviour of a0.s0 sends on it");
}

TEST(Circuits, BehavioursWithDifferentChannelsAreLeftToOtherMethods) {
  Pair pair;
  const auto x = pair.system.channel(pair.a, pair.b, receiver_blocks),
             y = pair.system.channel(pair.a, pair.b, receiver_blocks);
  pair.system.behaviour(pair.a, {x}, {});
  pair.system.leave(pair.a, {0}, false, {pair.system.behaviour(pair.a, {y}, {})});
  pair.system.leave(pair.a, {1}, false, {{0}});
  pair.system.behaviour(pair.b, {}, {x, y});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::unknown);
  EXPECT_EQ(story(judged), "'a0.s0': its behaviours use different channels, or in different orders");
}

}  // namespace
}  // namespace tessera::test
