#include "system/deadline_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tessera::testing {
namespace {

TEST(DeadlineQueue, AgreesWithASortedSet) {
  constexpr std::uint32_t size = 40;
  DeadlineQueue queue(size);
  std::vector<Time> times(size, Time::max());
  std::mt19937_64 random(1);
  for (int round = 0; round < 20'000; ++round) {
    const auto index = static_cast<std::uint32_t>(random() % size);
    const Time time = random() % 4 == 0 ? Time::max() : Time(Duration(random() % 50));
    queue.set(index, time);
    times[index] = time;
    const auto first = std::min_element(times.begin(), times.end());
    ASSERT_EQ(queue.empty(), *first == Time::max());
    if (queue.empty()) continue;
    ASSERT_EQ(queue.first_time(), *first);
    ASSERT_EQ(queue.first(), first - times.begin());
  }
}

}  // namespace
}  // namespace tessera::testing
