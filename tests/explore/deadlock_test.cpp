#include <gtest/gtest.h>

#include "explore/explore.hpp"
#include "small_nets.hpp"

namespace tessera::explore {
namespace {

using Kind = Answer::Kind;

TEST(FindDeadlock, ManyPhilosophersStarveAfterFewMarkings) {
  for (const std::uint32_t count : {2U, 10U, 50U, 500U}) {
    const PtNet net(philosophers(count));
    const Answer answer = find_deadlock(net, Formula::never(), {});
    ASSERT_EQ(answer.kind, Kind::yes) << answer.why;
    // Everybody takes one fork, and no firing of the trace can be spared.
    EXPECT_EQ(answer.trace.firings.size(), count);
    EXPECT_EQ(replay(net, answer.trace.firings), answer.trace.end);
    EXPECT_TRUE(holds(Formula::dead(), net, answer.trace.end));
    EXPECT_LT(answer.effort.markings, 30'000U);
  }
}

TEST(FindDeadlock, OneLeftHandedPhilosopherSavesAll) {
  net::Net net;
  const net::Net right_handed = philosophers(6);
  for (const net::Place& place : right_handed.places()) net.add(place);
  const auto copy = [&](std::uint32_t from) {
    const TransitionId id{from};
    net.add(right_handed[id], right_handed.preset(id), right_handed.postset(id));
  };
  join(net, {{0, 1}, {7, 1}}, {{1, 1}});  // takes the other fork first
  join(net, {{1, 1}, {3, 1}}, {{2, 1}});
  for (std::uint32_t transition = 2; transition < right_handed.transitions().size(); ++transition)
    copy(transition);
  EXPECT_EQ(find_deadlock(PtNet(net), Formula::never(), {}).kind, Kind::no);
}

TEST(FindDeadlock, FinalMarkingsAreNotUnwanted) {
  const PtNet net(fork_in_the_road());
  EXPECT_EQ(find_deadlock(net, Formula::never(), {}).kind, Kind::yes);
  EXPECT_EQ(find_deadlock(net, Formula::marked(PlaceId{2}), {}).kind, Kind::no);
}

TEST(FindDeadlock, TheInitialMarkingMayBeDead) {
  const Answer answer = find_deadlock(PtNet(places_with({1})), Formula::never(), {});
  EXPECT_EQ(answer.kind, Kind::yes);
  EXPECT_TRUE(answer.trace.firings.empty());
}

TEST(FindDeadlock, IndependentRingsAreVisitedOneAfterTheOther) {
  net::Net net;
  constexpr std::uint32_t rings = 20, places = 5;
  for (std::uint32_t place = 0; place < rings * places; ++place) {
    net::Place part;
    part.tokens = place % places == 0 ? 1 : 0;
    net.add(std::move(part));
  }
  for (std::uint32_t place = 0; place < rings * places; ++place)
    join(net, {{place, 1}}, {{place % places + 1 == places ? place + 1 - places : place + 1, 1}});
  const Answer answer = find_deadlock(PtNet(net), Formula::never(), {});
  EXPECT_EQ(answer.kind, Kind::no);
  EXPECT_LE(answer.effort.markings, rings * places);  // of 5^20
}

}  // namespace
}  // namespace tessera::explore
