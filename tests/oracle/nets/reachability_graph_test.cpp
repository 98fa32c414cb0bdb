#include "oracle/nets/reachability_graph.hpp"

#include <gtest/gtest.h>

namespace oracle {
namespace {

using Transition = PetriNet::Transition;

PetriNet ring_of_three(std::uint32_t tokens) {
  return {{tokens, 0, 0}, {{{{0}}, {{1}}}, {{{1}}, {{2}}}, {{{2}}, {{0}}}}};
}

/// From place 0 to place 1, which goes round for ever, or to place 2, a dead end.
PetriNet fork_in_the_road() { return {{1, 0, 0}, {{{{0}}, {{1}}}, {{{0}}, {{2}}}, {{{1}}, {{1}}}}}; }

ReachabilityGraph::States marked(const ReachabilityGraph& graph, std::size_t place) {
  return graph.where([&](const Marking& marking) { return marking[place] > 0; });
}

TEST(ReachabilityGraph, HoldsTheMarkingsOfARing) {
  const auto graph = ReachabilityGraph::of(ring_of_three(2), 6);
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->size(), 6U);  // two tokens on three places
  EXPECT_EQ(graph->edges().size(), 9U);
  EXPECT_EQ(graph->most_tokens(), 2U);
  const auto all_in_the_last = graph->find({0, 0, 2});
  ASSERT_TRUE(all_in_the_last);
  EXPECT_EQ(graph->run_to(*all_in_the_last).size(), 4U);
  EXPECT_TRUE(every(graph->can_reach(graph->where([](const Marking& m) { return m[2] == 2; }))));
}

TEST(ReachabilityGraph, StopsAtItsLimit) {
  EXPECT_FALSE(ReachabilityGraph::of(ring_of_three(2), 5));
  const ReachabilityGraph part(ring_of_three(2), 5);
  EXPECT_FALSE(part.complete());
  EXPECT_FALSE(ReachabilityGraph({{0}, {{{}, {{0}}}}}, 100).complete());
}

TEST(ReachabilityGraph, SeesThatABranchMayBeLost) {
  const ReachabilityGraph graph(fork_in_the_road(), 100);
  const auto start = marked(graph, 0), round = marked(graph, 1);
  EXPECT_EQ(graph.can_reach(round)[0], 1);
  EXPECT_FALSE(every(graph.can_reach(round)));
  EXPECT_TRUE(some(graph.losing(start, round)));
  EXPECT_FALSE(some(graph.losing(round, round)));
  EXPECT_TRUE(graph.dead(*graph.find({0, 0, 1})));
  EXPECT_EQ(graph.can_fire_for_ever({0, 0, 1}), (ReachabilityGraph::States{1, 1, 0}));
  EXPECT_FALSE(some(graph.can_fire_for_ever({1, 1, 0})));
}

TEST(Firing, SeveralArcsToOnePlaceCountTogether) {
  const Transition transition{{{0}, {0}}, {{1}, {1, 2}}};
  EXPECT_FALSE(fired(transition, {1, 0}));
  EXPECT_EQ(fired(transition, {3, 0}), (Marking{1, 3}));
}

TEST(Firing, ATransitionThatNeverFiresIsNotEnabled) {
  EXPECT_FALSE(fired(Transition{{}, {{0}}, true}, {0}));
  EXPECT_TRUE(fired(Transition{{}, {{0}}}, {0}));
}

}  // namespace
}  // namespace oracle
