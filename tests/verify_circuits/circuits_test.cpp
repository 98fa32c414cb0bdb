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

/// The first group with something to tell, in words.
std::string story(const Judged& judged) {
  for (const verify::CircuitGroup& group : judged.report.groups) {
    if (!group.applies()) return group.why_not;
    if (!group.circuit.empty()) return verify::in_words(judged.structure, group);
  }
  return "";
}

struct Pair {
  SystemBuilder system;
  spec::Index a = system.subsystem(), b = system.subsystem();
};

TEST(Circuits, CrossedBlockingReceivesWaitForEachOther) {
  Pair pair;
  const auto there = pair.system.channel(pair.a, pair.b, receiver_blocks);
  const auto back = pair.system.channel(pair.b, pair.a, receiver_blocks);
  const auto late = pair.system.channel(pair.b, pair.a, both_block);
  // a waits for the acknowledgement of nothing; b sends back only after an acknowledged `late`, which a reads last.
  pair.system.behaviour(pair.a, {there}, {back, late});
  pair.system.behaviour(pair.b, {late, back}, {there});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::no);
  EXPECT_EQ(judged.report.deadlock_free, Answer::no);
  EXPECT_EQ(judged.report.groups.front().cause, Cause::no_token);
  EXPECT_EQ(story(judged),
            "a0.s0 waits for a value of a1.s1.y1->a0.s0.x1 from a1.s1; "
            "a1.s1 waits for the acknowledgement of a1.s1.y2->a0.s0.x2 from a0.s0");
}

TEST(Circuits, SendingFirstGivesTheTokenThatCrossedReceivesNeed) {
  Pair pair;
  const auto there = pair.system.channel(pair.a, pair.b, receiver_blocks);
  const auto back = pair.system.channel(pair.b, pair.a, receiver_blocks);
  pair.system.behaviour(pair.a, {there}, {back});
  pair.system.behaviour(pair.b, {back}, {there});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::yes);
  EXPECT_EQ(judged.report.deadlock_free, Answer::yes);
  EXPECT_EQ(judged.report.channels_flow, Answer::yes);
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

TEST(Circuits, ATimeoutAtEitherEndBreaksTheWait) {
  for (const bool at_sender : {false, true}) {
    Pair pair;
    const auto x = pair.system.channel(pair.a, pair.b, {true, true, at_sender, !at_sender});
    const auto y = pair.system.channel(pair.b, pair.a, {true, true, at_sender, !at_sender});
    pair.system.behaviour(pair.a, {x}, {y});
    pair.system.behaviour(pair.b, {y}, {x});
    EXPECT_EQ(judge(pair.system.result()).report.goes_on, at_sender ? Answer::no : Answer::no);
  }
}

TEST(Circuits, OneStuckAgentAmongRunningOnesIsFoundThoughNothingDeadlocks) {
  Pair pair;
  const auto x = pair.system.channel(pair.a, pair.b, both_block), y = pair.system.channel(pair.b, pair.a, both_block);
  pair.system.behaviour(pair.a, {x}, {y});
  pair.system.behaviour(pair.b, {y}, {x});
  const auto free = pair.system.subsystem();
  pair.system.behaviour(free, {}, {});
  const Judged judged = judge(pair.system.result());
  EXPECT_EQ(judged.report.goes_on, Answer::no);
  EXPECT_EQ(judged.report.deadlock_free, Answer::yes);
}

TEST(Circuits, AStartUpThatSendsFirstIsTheTokenOfARing) {
  for (const bool primed : {false, true}) {
    SystemBuilder system;
    std::vector<spec::Index> ring, channels;
    for (int number = 0; number < 3; ++number) ring.push_back(system.subsystem());
    for (std::size_t number = 0; number < 3; ++number)
      channels.push_back(system.channel(ring[number], ring[(number + 1) % 3], both_block));
    const auto first = system.channel(ring[0], ring[1], receiver_blocks);
    const auto answer = system.channel(ring[1], ring[0], {true, true, false, true});
    (void)answer;
    (void)first;
    SystemBuilder tokens;
    std::vector<spec::Index> round;
    for (int number = 0; number < 2; ++number) round.push_back(tokens.subsystem());
    const auto there = tokens.channel(round[0], round[1], receiver_blocks);
    const auto back = tokens.channel(round[1], round[0], receiver_blocks);
    const auto gate = tokens.channel(round[1], round[0], both_block);
    spec::Index start = 0;
    if (primed) start = tokens.behaviour(round[0], {there}, {});
    const auto main = tokens.behaviour(round[0], {there}, {gate, back});
    if (primed) tokens.leave(round[0], start, true, {main});
    tokens.behaviour(round[1], {gate, back}, {there});
    EXPECT_EQ(judge(tokens.result()).report.goes_on, Answer::yes);
  }
}

}  // namespace
}  // namespace tessera::test
