// Times in words.
#include "timing/words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "spec/model/chain_ways.hpp"

namespace tessera::timing {
namespace {

struct Written {
  Time time;
  const char* text;
};
constexpr auto list = std::to_array<Written>({
#include "time_texts.inc"
});

TEST(Words, ATimeIsWrittenAsTheStudioWritesIt) {
  for (const Written& one : list) EXPECT_EQ(time_text(one.time), one.text);
  EXPECT_EQ(bound_text(82'000'000), "82 ms");
  EXPECT_EQ(bound_text(unbounded), "no bound");
}

TEST(Words, MembersOfAFleetHaveOneName) {
  EXPECT_EQ(spec::fleet_name_of("robot.control"), "robot.control");
  EXPECT_EQ(spec::fleet_name_of("robot[12].control -> cart[0].motor"), "robot[].control -> cart[].motor");
}

}  // namespace
}  // namespace tessera::timing
