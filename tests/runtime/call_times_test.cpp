// Times of calls that are drawn between two.
#include "subsystem/call_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace tessera {
namespace {

using namespace std::chrono_literals;

std::vector<Duration> draws(std::uint64_t seed, std::string_view path, const Behaviour& behaviour) {
  CallTimes times(seed, path);
  std::vector<Duration> all;
  for (int call = 0; call < 20'000; ++call) all.push_back(times.draw(behaviour));
  return all;
}

TEST(CallTimes, LieBetweenTheTwoAndAreEquallyLikely) {
  const std::vector<Duration> all = draws(1, "robot.control", {"drive", 1ms, 3ms});
  EXPECT_GE(*std::ranges::min_element(all), 1ms);
  EXPECT_LE(*std::ranges::max_element(all), 3ms);
  for (int part = 0; part < 10; ++part) {
    const Duration from = 1ms + part * 200us;
    const auto count =
        std::ranges::count_if(all, [&](Duration one) { return one >= from && one < from + 200us; });
    EXPECT_NEAR(static_cast<double>(count), 2000, 200) << part;  // 4.7 standard deviations
  }
}

TEST(CallTimes, BothEndsAreReached) {
  const std::vector<Duration> all = draws(1, "robot.control", {"drive", 0ns, 2ns});
  for (const Duration time : {0ns, 1ns, 2ns})
    EXPECT_NE(std::ranges::find(all, time), all.end()) << time.count();
}

TEST(CallTimes, DependOnSeedAndPathOnly) {
  const Behaviour drive{"drive", 1ms, 3ms};
  EXPECT_EQ(draws(1, "robot.control", drive), draws(1, "robot.control", drive));
  EXPECT_NE(draws(1, "robot.control", drive), draws(2, "robot.control", drive));
  EXPECT_NE(draws(1, "robot[1].control", drive), draws(1, "robot[2].control", drive));
}

TEST(CallTimes, OneTimeIsThatOfEachCall) {
  for (const Duration time : draws(1, "robot.control", {"drive", 2ms})) EXPECT_EQ(time, 2ms);
  for (const Duration time : draws(1, "robot.control", {"drive"})) EXPECT_EQ(time, 0ns);
}

}  // namespace
}  // namespace tessera
