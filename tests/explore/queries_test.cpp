#include <gtest/gtest.h>

#include "explore/explore.hpp"
#include "small_nets.hpp"

namespace tessera::explore {
namespace {

using Kind = Answer::Kind;

Formula marked(std::uint32_t place) { return Formula::marked(PlaceId{place}); }

TEST(Count, WidensFieldsUntilEveryMarkingFits) {
  net::Net net = places_with({1, 0});
  join(net, {{0, 1}}, {{1, 1000}});
  const Count counted = count(PtNet(net), {});
  EXPECT_TRUE(counted.complete);
  EXPECT_EQ(counted.markings, 2U);
  EXPECT_EQ(counted.most_tokens, 1000U);
}

TEST(Count, ANetWithoutTransitionsHasOneMarking) {
  const Count counted = count(PtNet(places_with({3})), {});
  EXPECT_TRUE(counted.complete);
  EXPECT_EQ(counted.markings, 1U);
  EXPECT_EQ(counted.edges, 0U);
  EXPECT_EQ(counted.most_tokens, 3U);
}

TEST(Count, ANetWithoutPlacesHasOneMarking) {
  net::Net net;
  join(net, {}, {});
  const Count counted = count(PtNet(net), {});
  EXPECT_EQ(counted.markings, 1U);
  EXPECT_EQ(counted.edges, 1U);
}

TEST(Count, ManyTokensTakeWideFields) {
  const Count counted = count(PtNet(ring_of(4, 70)), {});
  EXPECT_TRUE(counted.complete);
  EXPECT_EQ(counted.markings, 62'196U);  // 73 over 3
  EXPECT_EQ(counted.most_tokens, 70U);
}

TEST(Count, MarkingsOfManyWordsAreCounted) {
  net::Net net = places_with({});
  for (std::uint32_t ring = 0; ring < 12; ++ring) {
    for (std::uint32_t place = 0; place < 40; ++place) {
      net::Place part;
      part.tokens = place < 2 ? 1 : 0;
      net.add(std::move(part));
    }
  }
  join(net, {{0, 1}, {1, 1}}, {{2, 2}});  // one run of two steps: two more markings
  join(net, {{2, 2}}, {{3, 1}});
  const Count counted = count(PtNet(net), {});
  EXPECT_TRUE(counted.complete);
  EXPECT_EQ(counted.markings, 3U);
  EXPECT_EQ(counted.most_tokens, 2U);
}

TEST(Find, AnInitialMarkingNeedsNoFiring) {
  const Answer answer = find(PtNet(ring_of(3, 1)), marked(0), {});
  EXPECT_EQ(answer.kind, Kind::yes);
  EXPECT_TRUE(answer.trace.firings.empty());
}

TEST(Find, GoesTheShortestWay) {
  const Answer answer = find(PtNet(ring_of(50, 1)), marked(49), {});
  EXPECT_EQ(answer.kind, Kind::yes);
  EXPECT_EQ(answer.trace.firings.size(), 49U);
  EXPECT_TRUE(answer.shortest);
}

TEST(Find, EndsBeforeAnUnboundedNetDoes) {
  const Answer answer = find(PtNet(spring()), Formula::at_least(PlaceId{0}, 100), {});
  EXPECT_EQ(answer.kind, Kind::yes);
  EXPECT_EQ(answer.trace.firings.size(), 100U);
}

TEST(AlwaysReachable, NamesTheFirstMarkingWithoutAWayBack) {
  const PtNet net(fork_in_the_road());
  const Answer answer = always_reachable(net, marked(1), {});
  EXPECT_EQ(answer.kind, Kind::no);
  EXPECT_EQ(answer.trace.firings, std::vector{TransitionId{1}});
  EXPECT_EQ(always_reachable(net, Formula::any({marked(1), marked(2)}), {}).kind, Kind::yes);
}

TEST(LeadsTo, FollowsTheBranchThatIsLost) {
  const PtNet net(fork_in_the_road());
  const Answer answer = leads_to(net, marked(0), marked(1), {});
  EXPECT_EQ(answer.kind, Kind::no);
  EXPECT_EQ(answer.turn, 0U);
  EXPECT_EQ(answer.trace.firings, std::vector{TransitionId{1}});
  EXPECT_EQ(leads_to(net, marked(0), Formula::any({marked(1), marked(2)}), {}).kind, Kind::yes);
}

TEST(LeadsTo, ALoopThatCanBeLeftIsNotWaitedIn) {
  net::Net net = places_with({1, 0});
  join(net, {{0, 1}}, {{0, 1}});
  join(net, {{0, 1}}, {{1, 1}});
  EXPECT_EQ(leads_to(PtNet(net), marked(0), marked(1), {}).kind, Kind::yes);
}

TEST(CanAlwaysFire, AnswersEachObligationByItself) {
  const PtNet net(fork_in_the_road());
  const auto answers = can_always_fire(
      net, {{{TransitionId{2}}, Formula::never()}, {{TransitionId{2}}, marked(2)}, {{}, Formula::always()}},
      {});
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0].kind, Kind::no);
  EXPECT_EQ(answers[0].trace.firings, std::vector{TransitionId{1}});
  EXPECT_EQ(answers[1].kind, Kind::yes);
  EXPECT_EQ(answers[2].kind, Kind::yes);
}

TEST(Replay, RefusesARunThatIsNone) {
  const PtNet net(ring_of(3, 1));
  EXPECT_EQ(replay(net, {TransitionId{0}, TransitionId{1}}), (Marking{0, 0, 1}));
  EXPECT_FALSE(replay(net, {TransitionId{1}}));
  EXPECT_FALSE(replay(net, {TransitionId{9}}));
}

}  // namespace
}  // namespace tessera::explore
