#include "nets/shared_channel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace tessera::testing {
namespace {

constexpr std::uint16_t empty = 1, full = 2;

/// Counts the wake-ups of each side.
struct CountingWaker final : Waker {
  std::vector<int> woken = std::vector<int>(2);
  void wake(std::uint32_t instance) override { ++woken[instance]; }
};

/// A buffered channel; sender 0, receiver 1. Needs of both: 0 = empty, 1 = full. With a thread for each side,
/// or one for both, the rules are the same.
struct Buffered : ::testing::TestWithParam<bool> {
  CountingWaker waker;
  SharedChannel channel{empty, sizeof(double)};
  Buffered() {
    if (GetParam()) channel.set_single_threaded();
    channel.connect(Side::send, &waker, 0, {empty, full});
    channel.connect(Side::receive, &waker, 1, {empty, full});
  }
};

TEST_P(Buffered, FiringNeedsItsPlacesAndCountsVersions) {
  EXPECT_EQ(channel.fire(Side::receive, full, 0), 0u);
  EXPECT_EQ(channel.fire(Side::send, empty, 0), 1u);
  EXPECT_EQ(channel.fire(Side::send, 0, full), 2u);
  EXPECT_EQ(channel.marking(), full);
  EXPECT_EQ(channel.fire(Side::receive, full, 0), 3u);
}

TEST_P(Buffered, SkipIsAFiringOfItsOwnVersion) {
  EXPECT_EQ(channel.fire(Side::receive, empty, empty), 1u);
  EXPECT_EQ(channel.fire(Side::receive, empty, empty), 2u);
  EXPECT_EQ(channel.marking(), empty);
}

TEST_P(Buffered, RegistrationIsRefusedWhenANeedIsMet) {
  EXPECT_FALSE(channel.wait(Side::send, 0b01));
  EXPECT_TRUE(channel.wait(Side::receive, 0b10));
}

TEST_P(Buffered, AMetNeedWakesWhoWaitsForIt) {
  ASSERT_TRUE(channel.wait(Side::receive, 0b10));
  ASSERT_NE(channel.fire(Side::send, empty, 0), 0u);
  EXPECT_EQ(waker.woken[1], 0);
  ASSERT_NE(channel.fire(Side::send, 0, full), 0u);
  EXPECT_EQ(waker.woken[1], 1);
}

TEST_P(Buffered, FiringEndsARegistration) {
  ASSERT_TRUE(channel.wait(Side::receive, 0b10));
  ASSERT_NE(channel.fire(Side::send, empty, full), 0u);
  ASSERT_NE(channel.fire(Side::receive, full, empty), 0u);
  ASSERT_NE(channel.fire(Side::send, empty, full), 0u);
  EXPECT_EQ(waker.woken[1], 1) << "it waits no more";
}

TEST_P(Buffered, WhoFiredLastMayGoOnUntilTheOtherHasWaitedInVain) {
  ASSERT_NE(channel.fire(Side::receive, empty, 0), 0u);
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_NE(channel.fire(Side::receive, 0, empty), 0u);
  EXPECT_EQ(waker.woken[0], 1);
  ASSERT_NE(channel.fire(Side::receive, empty, 0), 0u) << "the sender has been woken, no more";
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_NE(channel.fire(Side::receive, 0, empty), 0u);
  EXPECT_EQ(channel.fire(Side::receive, empty, 0), 0u) << "now it insists";
  ASSERT_NE(channel.fire(Side::send, empty, 0), 0u);
  ASSERT_NE(channel.fire(Side::send, 0, empty), 0u);
  EXPECT_NE(channel.fire(Side::send, empty, 0), 0u) << "nobody waits any more";
}

TEST_P(Buffered, WhoFiredLastYieldsToTheOtherThatInsists) {
  ASSERT_NE(channel.fire(Side::receive, empty, empty), 0u);  // skip
  ASSERT_NE(channel.fire(Side::receive, empty, 0), 0u);      // as if it held the memory
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_NE(channel.fire(Side::receive, 0, empty), 0u);
  EXPECT_EQ(waker.woken[0], 1);
  EXPECT_EQ(channel.fire(Side::receive, empty, empty), 0u) << "the sender was first";
  EXPECT_TRUE(channel.wait(Side::receive, 0b01)) << "so the receiver waits";
  ASSERT_NE(channel.fire(Side::send, empty, 0), 0u);
  EXPECT_EQ(waker.woken[1], 0) << "what it waits for has gone";
}

TEST_P(Buffered, WithdrawalReleasesWhoYielded) {
  ASSERT_NE(channel.fire(Side::receive, empty, 0), 0u);
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_TRUE(channel.wait(Side::send, 0b01));
  ASSERT_NE(channel.fire(Side::receive, 0, empty), 0u);
  ASSERT_TRUE(channel.wait(Side::receive, 0b01));
  ASSERT_TRUE(channel.wait(Side::send, 0));
  EXPECT_EQ(waker.woken[1], 1);
  EXPECT_NE(channel.fire(Side::receive, empty, empty), 0u);
}

INSTANTIATE_TEST_SUITE_P(Threads, Buffered, ::testing::Bool(),
                         [](const auto& one) { return one.param ? "OneForBoth" : "OneForEach"; });

TEST(SharedChannel, ANeedMetInPartHoldsNobodyBack) {
  CountingWaker waker;
  constexpr std::uint16_t lock = 1, item = 2, free = 4;
  SharedChannel channel(lock | free, sizeof(double));
  channel.connect(Side::send, &waker, 0, {lock | free});
  channel.connect(Side::receive, &waker, 1, {lock | item});
  ASSERT_TRUE(channel.wait(Side::receive, 1));
  ASSERT_TRUE(channel.wait(Side::receive, 1));
  ASSERT_NE(channel.fire(Side::send, lock | free, lock | free),
            0u);  // took and gave back: the receiver still lacks an item
  EXPECT_NE(channel.fire(Side::send, lock | free, lock | item), 0u);
  EXPECT_EQ(waker.woken[1], 1);
}

TEST(SharedChannel, TwoThreadsNeverHoldTheMemoryAtOnceAndNobodyStarves) {
  struct Words final : Waker {
    WakeWord words[2];
    void wake(std::uint32_t instance) override { words[instance].wake(); }
  } waker;
  SharedChannel channel(1, sizeof(double));
  channel.connect(Side::send, &waker, 0, {1});
  channel.connect(Side::receive, &waker, 1, {1});
  constexpr int rounds = 20'000;
  std::uint64_t guarded = 0;  // no atomic: the channel is the lock
  const auto work = [&](Side side) {
    WakeWord& word = waker.words[static_cast<std::size_t>(side)];
    for (int round = 0; round < rounds; ++round) {
      for (;;) {
        const std::uint32_t ticket = word.ticket();
        if (channel.fire(side, 1, 0) != 0) break;
        if (channel.wait(side, 1)) word.sleep(ticket, -1);
      }
      ++guarded;
      ASSERT_NE(channel.fire(side, 0, 1), 0u);
    }
  };
  std::thread other(work, Side::receive);
  work(Side::send);
  other.join();
  EXPECT_EQ(guarded, 2u * rounds);
}

}  // namespace
}  // namespace tessera::testing
