#include "tessera/nearest.hpp"

#include <gtest/gtest.h>

namespace tessera {
namespace {

struct Case {
  std::string word, expected;
};

class Nearest : public testing::TestWithParam<Case> {};

TEST_P(Nearest, FindsWhatWasMeant) {
  const std::vector<std::string> words{"gripper", "sensor",   "terminal",   "next",
                                       "x",       "Velocity", "velocities", "blocking"};
  EXPECT_EQ(nearest(GetParam().word, words), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(Words, Nearest,
                         testing::Values(Case{"gripr", "gripper"}, Case{"sensro", "sensor"},
                                         Case{"terminate", "terminal"}, Case{"nxt", "next"}, Case{"y", ""},
                                         Case{"", ""}, Case{"banana", ""}, Case{"NEXT", "next"},
                                         Case{"velocity", "Velocity"}, Case{"block", "blocking"},
                                         Case{"next", ""}, Case{std::string(10'000'000, 'g'), ""}));

TEST(Nearest, CaseBeatsAnotherLetter) { EXPECT_EQ(nearest("pose", {"poses", "Pose"}), "Pose"); }

TEST(Nearest, TheSameCaseBreaksTies) { EXPECT_EQ(nearest("posee", {"Pose", "pose"}), "pose"); }

TEST(DidYouMean, IsAQuestionOrNothing) {
  EXPECT_EQ(did_you_mean("gripr", {"gripper"}).text, "did you mean 'gripper'?");
  EXPECT_EQ(did_you_mean("gripr", {"gripper"}).proposal, "gripper");
  EXPECT_TRUE(did_you_mean("banana", {"gripper"}).empty());
  EXPECT_FALSE(did_you_mean("banana", {"gripper"}).proposal);
}

TEST(WithHint, JoinsMessageAndHint) {
  EXPECT_EQ(with_hint("unknown 'a'", "did you mean 'b'?"), "unknown 'a'; did you mean 'b'?");
  EXPECT_EQ(with_hint("unknown 'a'", ""), "unknown 'a'");
}

}  // namespace
}  // namespace tessera
