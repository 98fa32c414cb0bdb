#include "ros2/codec/seen_requests.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace tessera::ros2 {
namespace {

RelatedIdentity request(std::uint16_t client, std::int64_t number) {
  RelatedIdentity made;
  made.endpoint[0] = static_cast<std::uint8_t>(client);
  made.endpoint[1] = static_cast<std::uint8_t>(client >> 8U);
  made.sequence = number;
  return made;
}

TEST(SeenRequests, EachIsNewOnceInAnyOrder) {
  SeenRequests seen;
  for (const std::int64_t number : {5, 3, 4, 9, 1, 200}) {
    EXPECT_TRUE(seen.is_new(request(1, number))) << number;
    EXPECT_FALSE(seen.is_new(request(1, number))) << number;
    EXPECT_TRUE(seen.is_new(request(2, number))) << "of another client";
  }
  for (const std::int64_t number : {5, 3, 4, 9, 1, 200}) EXPECT_FALSE(seen.is_new(request(1, number)));
  EXPECT_TRUE(seen.is_new(request(1, 2)));
}

TEST(SeenRequests, OneFarBehindTheNewestCountsAsSeen) {
  SeenRequests seen;
  constexpr std::int64_t window = SeenRequests::window;
  EXPECT_TRUE(seen.is_new(request(1, 10'000)));
  EXPECT_TRUE(seen.is_new(request(1, 10'001 - window)));
  EXPECT_FALSE(seen.is_new(request(1, 10'000 - window)));
  EXPECT_TRUE(seen.is_new(request(1, 10'000 + 5 * window)));
  EXPECT_FALSE(seen.is_new(request(1, 10'000)));
}

TEST(SeenRequests, ExtremeNumbersHarmNothing) {
  constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
  SeenRequests seen;
  EXPECT_TRUE(seen.is_new(request(1, lowest)));
  EXPECT_TRUE(seen.is_new(request(1, highest)));
  EXPECT_FALSE(seen.is_new(request(1, highest)));
  EXPECT_FALSE(seen.is_new(request(1, lowest)));
  EXPECT_FALSE(seen.is_new(request(1, 0)));
}

TEST(SeenRequests, TheClientThatWasSeenLongestAgoIsForgotten) {
  SeenRequests seen;
  const auto most = static_cast<std::uint16_t>(SeenRequests::most_clients);
  for (std::uint16_t client = 0; client < most; ++client) EXPECT_TRUE(seen.is_new(request(client, 1)));
  EXPECT_FALSE(seen.is_new(request(0, 1)));
  EXPECT_TRUE(seen.is_new(request(most, 1)));
  EXPECT_FALSE(seen.is_new(request(0, 1)));
  EXPECT_TRUE(seen.is_new(request(1, 1)));
}

}  // namespace
}  // namespace tessera::ros2
