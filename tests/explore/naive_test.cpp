#include "naive.hpp"

#include <gtest/gtest.h>

#include "small_nets.hpp"

namespace tessera::explore {
namespace {

TEST(NaiveGraph, KnowsTheReachableMarkingsOfARing) {
  const net::Net ring = ring_of(3, 2);
  const auto graph = NaiveGraph::of(ring, 100);
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->size(), 6U);  // two tokens on three places
  EXPECT_EQ(graph->edges(), 9U);
  EXPECT_EQ(graph->most_tokens(), 2U);
  EXPECT_TRUE(graph->always_reachable(Formula::at_least(PlaceId{2}, 2)));
  EXPECT_FALSE(NaiveGraph::of(ring, 5));
}

TEST(NaiveGraph, SeesThatABranchMayBeLost) {
  const auto graph = NaiveGraph::of(fork_in_the_road(), 100);
  ASSERT_TRUE(graph);
  EXPECT_FALSE(graph->leads_to(Formula::marked(PlaceId{0}), Formula::marked(PlaceId{1})));
  EXPECT_TRUE(graph->leads_to(Formula::marked(PlaceId{1}), Formula::marked(PlaceId{1})));
  EXPECT_FALSE(graph->always_reachable(Formula::marked(PlaceId{1})));
}

}  // namespace
}  // namespace tessera::explore
