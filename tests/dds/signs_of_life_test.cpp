#include "network/dds/signs_of_life.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dds/crossing.hpp"

/// The link to another process as measured by signs of life, without a network: times and losses are given.
namespace tessera::test {
namespace {

using namespace std::chrono_literals;
using Time = std::chrono::nanoseconds;
using network::ClockOffset;
using network::ClockOffsetEstimate;

TEST(ClockOffset, TheShortestWayIsTheMostExactUntilItIsOld) {
  ClockOffsetEstimate estimate;
  EXPECT_FALSE(estimate.at(1s));
  estimate.add(100ms, 20ms, 1s);  // between 100 and 120 ms ahead
  EXPECT_EQ(estimate.at(1s)->ahead, 110ms);
  EXPECT_EQ(estimate.at(1s)->uncertainty, 10ms);
  estimate.add(104ms, 2ms, 2s);
  EXPECT_EQ(estimate.at(2s)->ahead, 105ms);
  EXPECT_EQ(estimate.at(2s)->uncertainty, 1ms);
  estimate.add(90ms, 30ms, 3s);  // says less
  EXPECT_EQ(estimate.at(3s)->ahead, 105ms);
  EXPECT_EQ(estimate.at(3s)->uncertainty, 1100us) << "two clocks drift apart";
  estimate.add(104ms, 4ms, 30s);
  EXPECT_EQ(estimate.at(30s)->uncertainty, 2ms) << "the older one is not more exact any more";
}

TEST(ClockOffset, AClockThatWasSetCountsAtOnce) {
  ClockOffsetEstimate estimate;
  estimate.add(0ms, 1ms, 1s);
  estimate.add(3600s, 8ms, 2s);
  EXPECT_EQ(estimate.at(2s)->ahead, 3600s + 4ms);
}

/// Two processes, each with clocks of its own, and a network between them.
struct Two {
  [[nodiscard]] static dds::Deployment deployment(network::ProcessNumber process, std::uint64_t incarnation) {
    return dds::deployment_of(Crossing().setup(process, incarnation));
  }
  /// A sign goes from one to the other; their clocks are as given when it goes and when it comes.
  dds::SignsOfLife office{deployment(Crossing::office, 10)}, cart{deployment(Crossing::cart, 20)};
};

TEST(SignsOfLife, AnEchoGivesTheClockOfTheOtherWithinTheTimeOnTheWay) {
  // The steady clock of the cart began 1000 s later, its clock of the day is 2 s ahead.
  const auto at_cart = [](Time time) { return time - 1000s + 5000s; };
  constexpr Time day = 1'700'000'000s, ahead = 2s;
  Two two;
  Time now = 5000s;
  const auto to_cart = two.office.next(now, day + now);
  now += 1ms;
  ASSERT_TRUE(two.cart.hear(to_cart, at_cart(now), day + ahead + now));
  now += 50ms;  // held
  std::optional<network::SignsOfLife> heard;
  // The echo goes to each peer in turn.
  for (int turn = 0; turn < 3; ++turn) {
    const auto back = two.cart.next(at_cart(now), day + ahead + now);
    now += 3ms;
    heard = two.office.hear(back, now, day + now);
    if (heard->clock) break;
  }
  ASSERT_TRUE(heard && heard->clock);
  EXPECT_EQ(heard->clock->uncertainty, 2ms) << "half of what both were on the way";
  EXPECT_LE(heard->clock->ahead - 2ms, ahead);
  EXPECT_GE(heard->clock->ahead + 2ms, ahead);
}

TEST(SignsOfLife, LostOnesAreCountedAmongTheNewest64AndLateOnesAreNot) {
  Two two;
  std::vector<tessera_wire_Alive> signs;
  for (int count = 0; count < 100; ++count) signs.push_back(two.cart.next(1s, 1s));
  const auto hear = [&](std::size_t number) { return *two.office.hear(signs.at(number), 2s, 2s); };
  EXPECT_EQ(hear(4).lost, 0U) << "what came before the first was sent to nobody";
  EXPECT_EQ(hear(5).expected, 2U);
  EXPECT_EQ(hear(8).lost, 2U);
  EXPECT_EQ(hear(7).lost, 1U) << "it was only late";
  EXPECT_EQ(hear(7).lost, 1U) << "twice is once";
  for (std::size_t number = 9; number < 99; ++number) EXPECT_LE(hear(number).lost, 1U);
  EXPECT_EQ(hear(99).expected, 64U);
  EXPECT_EQ(hear(99).lost, 0U) << "that was long ago";
}

TEST(SignsOfLife, ANewStartBeginsAnewAndAnOldOneIsIgnored) {
  Two two;
  const auto old = two.cart.next(1s, 1s);
  dds::SignsOfLife again{Two::deployment(Crossing::cart, 21)};
  EXPECT_EQ(two.office.hear(old, 2s, 2s)->expected, 1U);
  EXPECT_EQ(two.office.hear(again.next(1s, 1s), 3s, 3s)->expected, 1U);
  EXPECT_FALSE(two.office.hear(old, 4s, 4s));
}

TEST(SignsOfLife, TimesThatMakeNoSenseGiveNoClock) {
  for (const auto& [echo_ns, held_ns, wall_ns] :
       std::initializer_list<std::array<std::int64_t, 3>>{{-1, 0, 1},
                                                          {1, -1, 1},
                                                          {INT64_MAX, INT64_MAX, 1},
                                                          {1, INT64_MAX, 1},
                                                          {1, 1, INT64_MIN},
                                                          {1, 1, INT64_MAX},
                                                          {4'000'000'000, 0, 1}}) {
    Two two;
    const tessera_wire_Alive sign{.process = Crossing::cart,
                                  .incarnation = 20,
                                  .number = UINT64_MAX,
                                  .sent_ns = 0,
                                  .wall_ns = wall_ns,
                                  .echo_process = Crossing::office,
                                  .echo_incarnation = 10,
                                  .echo_ns = echo_ns,
                                  .held_ns = held_ns};
    const auto heard = two.office.hear(sign, 3s, 3s);
    EXPECT_TRUE(heard && !heard->clock) << echo_ns << " " << held_ns << " " << wall_ns;
  }
}

}  // namespace
}  // namespace tessera::test
